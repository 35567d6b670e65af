// The numbers of a skin that is put into a document: matrices, weights, keys, and vertices that its joints do not place any more.
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
  size_t add_inverse_binds(const Matrix4& world_transform);  // the accessor
  size_t add_binds_as_shown(const OrderedJson& joints);      // of a skin's nodes where they stand in the file
  // The rig's weights in the place of those that the primitive has.
  void add_weights(const GltfPrimitive& primitive);
  // Of a primitive that its joints placed: positions, normals, tangents and morph targets as they are shown.
  void place_vertices(const GltfPrimitive& primitive);
  // A skin's mesh ignores its node, a mirroring one too: its triangles are turned, so that their outside stays outside.
  void turn_triangles(const GltfPrimitive& primitive);
  void add_animation(const JointAnimation& animation, const std::vector<size_t>& joint_node);
  std::vector<std::byte> finish() { return writer_->finish(); }

  // Whether a node of the file, or one below it, is something to be seen and no joint: a prop, a lamp, a camera.
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
  std::vector<std::pair<std::vector<double>, size_t>> times_;  // and their accessors
  std::vector<bool> things_;                                   // a node of the file
};

}  // namespace focal
