// The checks an untrusted glTF file passes before any of it is used.
#pragma once
#include <cstddef>
#include <span>

#include "gltf/json.h"
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

// Checks the GLB header and chunk arithmetic. A .gltf is whatever does not begin like a .glb.
// Throws invalid_file, unsupported (glTF 1, a limit exceeded).
GltfContainer open_container(std::span<const std::byte> bytes, const GltfLimits& limits);

// Parses with the limits, then checks every count, index, offset and extent the reader relies on with 64-bit
// arithmetic, so that later code may index without asking again. After it: accessor extents lie in their
// views, views in the declared length of their buffers, every reference exists, and the nodes form a forest.
// Throws invalid_file, unsupported (required extension, limit, other glTF version).
JsonDocument parse_gltf(const GltfContainer& container, const GltfLimits& limits);

}  // namespace focal
