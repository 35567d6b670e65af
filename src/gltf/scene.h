// Which meshes the file shows, and where.
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/matrix.h"
#include "gltf/buffers.h"

namespace focal {

struct MeshPlacement {
  std::string name;  // "node 'Body'", "node 3" or "mesh 0", for messages
  int32_t mesh = -1;
  int32_t node = -1;  // -1: no node shows it
  Matrix4 world_transform = Matrix4::Identity();
  bool mirrored =
      false;  // by the node's place: it says which way round triangles are, for skinned meshes too
  bool is_character = false;  // it has a skin, or stands at or below a joint of one
};

struct ShownMeshes {
  std::vector<MeshPlacement> placements;
  std::vector<std::string> hidden;  // names of the nodes whose meshes KHR_node_visibility hides
};

// Where a node stands to its parent, as an animation gives it.
struct NodePose {
  Vector3 translation = Vector3::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Vector3 scale = Vector3::Ones();
};

NodePose pose_of(
    const nlohmann::json& node);  // of its translation, rotation and scale; a matrix is not looked at

// Of every node, with some of them in other poses than the file has.
std::vector<Matrix4> world_transforms(const nlohmann::json& root, const std::map<int32_t, NodePose>& poses);

// Each mesh once, in depth-first node order; see read_gltf for the choice of the scene, for hidden nodes and for skins.
// `root` has passed parse_gltf.
ShownMeshes placed_meshes(const nlohmann::json& root, GltfBuffers& buffers, bool hidden_too,
                          std::vector<std::string>& warnings);

}  // namespace focal
