// A folder of a test's own, removed at its end.
#pragma once
#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>

namespace focal_test {

struct TemporaryFolder {
  std::filesystem::path path;
  TemporaryFolder() {
    path = std::filesystem::temp_directory_path() / ("focal-test-" + std::to_string(std::random_device()()));
    if (!std::filesystem::create_directory(path)) throw std::runtime_error("cannot make " + path.string());
  }
  ~TemporaryFolder() {
    std::error_code left;
    std::filesystem::remove_all(path, left);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  int64_t entries() const {
    return std::distance(std::filesystem::directory_iterator(path), std::filesystem::directory_iterator());
  }
};

}  // namespace focal_test
