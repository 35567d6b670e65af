// The meshes that the file shows, and their transforms.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/matrix.h"
#include "gltf/buffers.h"
#include "mesh/animation.h"

namespace focal {

struct MeshPlacement {
  std::string name;  // "node 'Body'", "node 3" or "mesh 0", for messages
  int32_t mesh = -1;
  int32_t node = -1;  // -1: no node shows it
  Matrix4 world_transform = Matrix4::Identity();
  // The node's transform is a reflection, which reverses triangles, also of skinned meshes.
  bool mirrored = false;
  bool is_character = false;  // it has a skin, or is a joint of one or below it
  int32_t skin = -1;          // that moves it
  int32_t joint = -1;         // without a skin: the node of the joint of a used skin that it is below
  bool is_posed = false;      // its skin has all bind matrices at one position: the joints place each vertex
};

struct ShownMeshes {
  std::vector<MeshPlacement> placements;
  std::vector<std::string> hidden;  // names of the nodes whose meshes KHR_node_visibility hides
};

NodeTree node_tree(const tiny::Model& model);

// How a skin transforms its meshes. In the bind pose every joint gives the same transform, (its world
// transform) * (its inverse bind matrix). In another pose the topmost joint places the body as a whole.
struct SkinPlace {
  std::vector<Matrix4> inverse_bind;        // one per joint
  Matrix4 transform = Matrix4::Identity();  // from the bind pose to the world
  bool is_posed = false;                    // all bind matrices are at one position
  bool is_other_pose = false;               // the file shows another pose than the bind pose
  std::vector<Matrix4> carried;             // one per joint: as the file shows it
  Matrix4 bind(size_t joint) const;         // from the joint to the world, in the pose that is read
};
SkinPlace skin_place(const GltfView& view, GltfBuffers& buffers, const NodeTree& tree,
                     const std::vector<Matrix4>& world, int32_t skin);

// Each instance of a mesh, in depth-first node order; see GltfDocument::mesh for the choice of the scene, for
// hidden nodes and for skins.
ShownMeshes placed_meshes(const GltfView& view, GltfBuffers& buffers, bool hidden_too,
                          std::vector<std::string>& warnings);

}  // namespace focal
