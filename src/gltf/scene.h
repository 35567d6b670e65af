// Which meshes the file shows, and where.
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
  bool mirrored =
      false;  // by the node's place: it says which way round triangles are, for skinned meshes too
  bool is_character = false;  // it has a skin, or stands at or below a joint of one
  int32_t skin = -1;          // that moves it
  int32_t joint = -1;         // without a skin: the node of a worn skin's joint that it hangs on
  bool is_posed = false;  // its skin's bind matrices make no shape: each vertex goes where the joints have it
};

struct ShownMeshes {
  std::vector<MeshPlacement> placements;
  std::vector<std::string> hidden;  // names of the nodes whose meshes KHR_node_visibility hides
};

NodeTree node_tree(const tiny::Model& model);

// How a skin carries its meshes. In the bind pose every joint carries them alike, by (its world transform) * (its inverse bind
// matrix). In another pose the topmost joint places the body as a whole.
struct SkinPlace {
  std::vector<Matrix4> inverse_bind;        // one a joint
  Matrix4 transform = Matrix4::Identity();  // from the bind pose to the world
  bool is_posed = false;                    // the bind matrices make no shape: all joints in one place
  bool is_other_pose = false;               // the file shows another pose than the bind pose
  std::vector<Matrix4> carried;             // one a joint: what the file shows
  Matrix4 bind(size_t joint) const;         // from the joint to the world, in the pose that is read
};
SkinPlace skin_place(const GltfView& view, GltfBuffers& buffers, const NodeTree& tree,
                     const std::vector<Matrix4>& world, int32_t skin);

// Each instance of a mesh, in depth-first node order; see GltfDocument::mesh for the choice of the scene, for hidden nodes and for
// skins.
ShownMeshes placed_meshes(const GltfView& view, GltfBuffers& buffers, bool hidden_too,
                          std::vector<std::string>& warnings);

}  // namespace focal
