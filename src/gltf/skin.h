// The skeleton that a glTF file's skins make, and the weights of the vertices that read_gltf merged.
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

#include "gltf/reader.h"
#include "mesh/rig.h"

namespace focal {

// bytes, primitives: the file, and what read_gltf made of it. folder: of the buffers beside a .gltf. All skins of the shown
// meshes make one skeleton; bind matrices lead to the merged mesh's coordinates. Nothing when no shown mesh has a skin. Weights that are
// negative, NaN or infinite count as 0; invalid_weights, where given, gets their number.
// Throws what read_gltf throws; invalid_file (a weight of a joint that is not there, a bind matrix without an inverse).
std::optional<Rig> read_gltf_rig(std::span<const std::byte> bytes, std::span<const GltfPrimitive> primitives,
                                 const GltfLimits& limits = {},
                                 std::optional<std::filesystem::path> folder = std::nullopt,
                                 int64_t* invalid_weights = nullptr);

}  // namespace focal
