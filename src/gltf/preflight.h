// The checks of an untrusted glTF file before any of it is used.
#pragma once
#include "gltf/container.h"
#include "gltf/json.h"
#include "gltf/limits.h"

namespace focal {

// Parses with the limits, then checks in 64-bit arithmetic every count, index, offset and extent that the
// reader uses, so that later code may index without further checks. Afterwards accessor extents are within
// their views, views within the declared length of their buffers, every reference is valid, and the nodes
// form a forest. lenient: allows an empty accessor, and a mesh without primitives. Throws invalid_file,
// unsupported (required extension, limit, other glTF version).
JsonDocument parse_gltf(const GltfContainer& container, const GltfLimits& limits, bool lenient = false);

}  // namespace focal
