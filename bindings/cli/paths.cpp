#include "paths.h"

namespace focal_cli {

std::filesystem::path path_of(const std::string& text) { return std::u8string(text.begin(), text.end()); }

std::string text_of(const std::filesystem::path& path) {
  const std::u8string text = path.u8string();
  return {text.begin(), text.end()};
}

}  // namespace focal_cli
