// Which meshes the file shows, and where.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/matrix.h"
#include "gltf/buffers.h"

namespace focal {

struct MeshPlacement {
  int32_t mesh = -1;
  int32_t node = -1;  // -1: no node shows it
  Matrix4 world_transform = Matrix4::Identity();
};

// Each mesh once, in depth-first node order; see read_gltf for the choice of the scene and for skins.
// `root` has passed parse_gltf.
std::vector<MeshPlacement> placed_meshes(const nlohmann::json& root, GltfBuffers& buffers,
                                         std::vector<std::string>& warnings);

}  // namespace focal
