// Putting a .glb together, and JSON text for small parts of one.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/matrix.h"

namespace focal {

// Header, the JSON chunk (padded), then `chunks` as they stand (headers included).
// Throws unsupported when the sum does not fit the 32-bit length of the format.
std::vector<std::byte> glb_bytes(std::string_view json, std::span<const std::byte> chunks);

// A BIN chunk: header, data, padding.
std::vector<std::byte> bin_chunk(std::span<const std::byte> data);

std::string json_string(std::string_view text);  // quoted and escaped; bad UTF-8 is replaced
std::string json_number(double finite);          // shortest text that gives the same float
std::string json_array(const Vector3& finite);

}  // namespace focal
