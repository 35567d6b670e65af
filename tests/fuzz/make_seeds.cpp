// Writes the seeds, or checks that those written are still what this program makes.
// usage: focal_make_seeds FOLDER | --check FOLDER
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "seeds.h"

int main(int argc, char** argv) {
  const bool checks = argc == 3 && std::strcmp(argv[1], "--check") == 0;
  if (argc != 2 && !checks)
    return std::fprintf(stderr, "usage: focal_make_seeds FOLDER | --check FOLDER\n"), 2;
  const std::filesystem::path folder = argv[argc - 1];
  const auto all = fuzz::seeds();
  int different = 0;
  for (const auto& [name, bytes] : all) {
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!checks) {
      std::filesystem::create_directories((folder / name).parent_path());
      std::ofstream(folder / name, std::ios::binary) << text;
      continue;
    }
    std::ifstream stream(folder / name, std::ios::binary);
    if (std::string(std::istreambuf_iterator<char>(stream), {}) != text)
      std::fprintf(stderr, "%s is not what focal_make_seeds makes\n", name.c_str()), ++different;
  }
  std::printf("%zu seeds, %d different\n", all.size(), different);
  return different != 0;
}
