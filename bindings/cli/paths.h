// Paths and text. Text is UTF-8 on every platform; std::filesystem takes a char as Windows' code page.
#pragma once
#include <filesystem>
#include <string>

namespace focal_cli {

std::filesystem::path path_of(const std::string& text);
std::string text_of(const std::filesystem::path& path);

}  // namespace focal_cli
