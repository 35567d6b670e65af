// Numbers to and from the command line and files of the reference programs.
#pragma once
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace focal_test {

// Little-endian float64, nothing else: numpy.fromfile reads it. A vector or a matrix of doubles, as it lies
// in memory.
template <class Numbers>
void write_raw(const std::filesystem::path& path, const Numbers& numbers) {
  std::ofstream file(path, std::ios::binary);
  const double* first = numbers.data();
  file.write(reinterpret_cast<const char*>(first),
             static_cast<std::streamsize>(numbers.size() * sizeof(double)));
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

inline std::vector<int32_t> vertices_from(int first, int argc, char** argv) {
  std::vector<int32_t> vertices;
  for (int i = first; i < argc; ++i) vertices.push_back(std::atoi(argv[i]));
  return vertices;
}

}  // namespace focal_test
