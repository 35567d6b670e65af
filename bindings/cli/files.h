// Whole files in and out.
#pragma once
#include <string>
#include <string_view>

#include "write_file.h"

namespace focal_cli {

// Whatever the case of the path; the ending is in lower case.
bool has_ending(std::string_view path, std::string_view ending);

// .glb, .gltf, .vrm
bool is_gltf(std::string_view path);

std::string read_text_file(const std::string& path);

}  // namespace focal_cli
