// Whole files in and out. A file is either written completely or left as it was.
#pragma once
#include <string>
#include <string_view>

namespace focal_cli {

// Whatever the case of the path; the ending is in lower case.
bool has_ending(std::string_view path, std::string_view ending);

// .glb, .gltf, .vrm
bool is_gltf(std::string_view path);

std::string read_text_file(const std::string& path);

// Writes beside the target and renames over it, so that no reader ever sees half a file and a failure keeps
// the old one. A target that is not a regular file (/dev/stdout, a pipe) is written to directly.
void write_file_atomically(const std::string& path, std::string_view bytes);

}  // namespace focal_cli
