// The checks an untrusted glTF file passes before any of it is used.
#pragma once
#include "gltf/container.h"
#include "gltf/json.h"
#include "gltf/limits.h"

namespace focal {

// Parses with the limits, then checks every count, index, offset and extent the reader relies on with 64-bit
// arithmetic, so that later code may index without asking again. After it: accessor extents lie in their
// views, views in the declared length of their buffers, every reference exists, and the nodes form a forest.
// lenient: an accessor may be empty, and a mesh without primitives.
// Throws invalid_file, unsupported (required extension, limit, other glTF version).
JsonDocument parse_gltf(const GltfContainer& container, const GltfLimits& limits, bool lenient = false);

}  // namespace focal
