// Whole files out. A file is either written completely or left as it was.
#pragma once
#include <string>
#include <string_view>

namespace focal_cli {

// Writes beside the target and renames over it, so that no reader ever sees half a file and a failure keeps
// the old one. A target that is not a regular file (/dev/stdout, a pipe, NUL) is written to directly.
void write_file_atomically(const std::string& path, std::string_view bytes);

}  // namespace focal_cli
