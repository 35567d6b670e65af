// Whole files in.
#include "files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "command_error.h"
#include "paths.h"

namespace focal_cli {

namespace fs = std::filesystem;

bool has_ending(std::string_view path, std::string_view ending) {
  if (path.size() < ending.size()) return false;
  return std::equal(ending.rbegin(), ending.rend(), path.rbegin(),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b + 'a' - 'A' : b); });
}

bool is_gltf(std::string_view path) {
  return has_ending(path, ".glb") || has_ending(path, ".gltf") || has_ending(path, ".vrm");
}

std::string read_text_file(const std::string& path) {
  std::error_code code;
  const fs::path file = path_of(path);
  if (!fs::exists(file, code)) {
    throw CommandError("there is no file '" + path + "'", "check the path");
  }
  if (!fs::is_regular_file(file, code)) {
    throw CommandError("'" + path + "' is not a file", "give the path of a file, not of a folder");
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf() || stream.peek() == EOF)) {
    throw CommandError("cannot read '" + path + "'", "check that you may read it");
  }
  return std::move(text).str();
}

}  // namespace focal_cli
