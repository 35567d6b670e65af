// The two ways a glTF document comes: as text, or in a GLB of chunks.
#pragma once
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "gltf/limits.h"

namespace focal {

// The parts of a .glb, or the whole of a .gltf; spans into the caller's bytes.
struct GltfContainer {
  bool binary = false;
  std::span<const std::byte> json;
  bool has_bin = false;
  std::span<const std::byte> bin;   // the BIN chunk, padding included
  std::span<const std::byte> rest;  // every chunk after the JSON chunk, headers included, as they stand
};

// Checks the GLB header and chunk arithmetic. A .gltf is whatever does not begin like a .glb; what is plainly another kind of
// file is refused by its name. Throws invalid_file, unsupported (glTF 1, a limit exceeded).
GltfContainer open_container(std::span<const std::byte> bytes, const GltfLimits& limits);

// Header, the JSON chunk (padded), then `chunks` as they stand (headers included).
// Throws unsupported when the sum does not fit the 32-bit length of the format.
std::vector<std::byte> glb_bytes(std::string_view json, std::span<const std::byte> chunks);

// A BIN chunk: header, data, padding.
std::vector<std::byte> bin_chunk(std::span<const std::byte> data);

// The container with other JSON and, where `bin` is not empty, another BIN chunk; other chunks stay.
std::vector<std::byte> with_content(const GltfContainer& container, std::string_view json,
                                    std::span<const std::byte> bin);

}  // namespace focal
