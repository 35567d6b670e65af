// The data of a skin that is added to a document: matrices, weights, keys, and vertices that its joints no
// longer place.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gltf/accessor_writer.h"
#include "gltf/opened.h"

namespace focal {

class SkinData {
 public:
  SkinData(OrderedJson& root, const GltfRig& rig, const GltfView& view, GltfBuffers buffers,
           const GltfContainer& container)
      : root_(root), rig_(rig), view_(view), buffers_(std::move(buffers)), container_(container) {}

  void begin();
  size_t add_inverse_binds(const Matrix4& world_transform);  // returns the accessor
  size_t add_binds_as_shown(const OrderedJson& joints);      // of a skin's nodes in the pose of the file
  // Replaces the primitive's weights by those of the rig.
  void add_weights(const GltfPrimitive& primitive);
  // Of a primitive that its joints place: stores positions, normals, tangents and morph targets in the shown
  // pose.
  void place_vertices(const GltfPrimitive& primitive);
  // The mesh of a skin ignores its node, also a reflecting one: its triangles are reversed to stay
  // counter-clockwise from outside.
  void turn_triangles(const GltfPrimitive& primitive);
  void add_animation(const JointAnimation& animation, const std::vector<size_t>& joint_node);
  std::vector<std::byte> finish() { return writer_->finish(); }

  // Whether a node of the file, or one below it, is a visible object other than a joint: a prop, a lamp, a
  // camera.
  bool carries_a_thing(size_t node);

 private:
  OrderedJson& primitive_of(const GltfPrimitive& primitive) {
    return root_["meshes"][primitive.mesh]["primitives"][primitive.primitive];
  }
  void add_weight_set(const GltfPrimitive& primitive, const std::vector<VertexInfluences>& all, int set);
  template <class Move>
  void replace(OrderedJson& attributes, const char* name, bool has_bounds, const Move& move);
  void place_attributes(OrderedJson& attributes, const std::vector<Matrix4>& transforms, bool are_offsets);
  std::string free_animation_name(const std::string& name);
  void add_channel(OrderedJson& samplers, OrderedJson& channels, size_t node, const char* path,
                   const Keys& keys);
  size_t times_accessor(const std::vector<double>& times);
  const std::vector<bool>& things();

  OrderedJson& root_;
  const GltfRig& rig_;
  const GltfView& view_;
  GltfBuffers buffers_;
  const GltfContainer& container_;
  std::optional<AccessorWriter> writer_;
  std::vector<std::pair<std::vector<double>, size_t>> times_;  // times and their accessors
  std::vector<bool> things_;                                   // per node of the file
};

}  // namespace focal
