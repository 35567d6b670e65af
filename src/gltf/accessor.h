// Reads the numbers of an accessor.
#pragma once
#include <cstdint>

#include "base/matrix.h"
#include "gltf/buffers.h"
#include "gltf/element.h"

namespace focal {

// One row per entry; sparse entries substituted, normalised integers scaled to [0, 1] or [-1, 1]. Doubles
// represent every component type exactly. Matrices are column-major within the row.
RowMatrix read_accessor(const GltfView& view, GltfBuffers& buffers, int64_t index);

}  // namespace focal
