#include "arguments.h"

#include <limits>

#include "boundary.h"

namespace focal {

std::filesystem::path path_of(const char* path) {
  if (!path || !*path)
    throw Error(Status::invalid_argument, path ? "the path is empty" : "the path is NULL",
                "pass a file's path");
  return std::filesystem::path(reinterpret_cast<const char8_t*>(path));
}

std::string text_of(const std::filesystem::path& path) {
  const auto text = path.u8string();
  return {text.begin(), text.end()};
}

std::span<const std::byte> bytes_of(const void* data, uint64_t size) {
  require(data, "data");
  if (size > static_cast<uint64_t>(std::numeric_limits<std::ptrdiff_t>::max()))
    throw Error(Status::invalid_argument, "size is " + std::to_string(size) + " bytes",
                "pass the size of data");
  return {static_cast<const std::byte*>(data), static_cast<size_t>(size)};
}

void check_index(uint64_t index, uint64_t count, const char* owner, const char* things) {
  if (index < count) return;
  throw Error(Status::invalid_argument,
              std::string(owner) + " has " + std::to_string(count) + " " + things + ", there is no number " +
                  std::to_string(index),
              "count from 0");
}

void check_count(const char* name, uint64_t given, uint64_t wanted, const char* owner, const char* things) {
  if (given == wanted) return;
  throw Error(Status::invalid_argument,
              std::string(name) + " is " + std::to_string(given) + ", " + owner + " has " +
                  std::to_string(wanted) + " " + things,
              std::string("pass a block with an entry for each of the ") + things);
}

const char* text_at(const std::vector<std::string>& texts, uint64_t index, const char* owner,
                    const char* things) {
  check_index(index, texts.size(), owner, things);
  return texts[static_cast<size_t>(index)].c_str();
}

}  // namespace focal
