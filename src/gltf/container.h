// The two containers of a glTF document: JSON text, or a GLB of chunks.
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
  std::span<const std::byte> rest;  // every chunk after the JSON chunk, headers included, unchanged
};

// Checks the GLB header and the chunk sizes. Any file that does not start like a .glb counts as a .gltf;
// recognisable other file types are refused by their name. Throws invalid_file, unsupported (glTF 1, a limit
// exceeded).
GltfContainer open_container(std::span<const std::byte> bytes, const GltfLimits& limits);

// Header, the JSON chunk (padded), then `chunks` unchanged (headers included). Throws unsupported when the
// total does not fit the 32-bit length of the format.
std::vector<std::byte> glb_bytes(std::string_view json, std::span<const std::byte> chunks);

// A BIN chunk: header, data, padding.
std::vector<std::byte> bin_chunk(std::span<const std::byte> data);

// The container with other JSON and, if `bin` is not empty, another BIN chunk; other chunks are kept.
std::vector<std::byte> with_content(const GltfContainer& container, std::string_view json,
                                    std::span<const std::byte> bin);

}  // namespace focal
