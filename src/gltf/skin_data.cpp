#include "gltf/skin_data.h"

#include <Eigen/LU>
#include <algorithm>
#include <set>

#include "gltf/accessor.h"
#include "gltf/scene.h"

namespace focal {
namespace {

using Json = OrderedJson;

std::vector<float> single(const RowMatrix& rows) {
  std::vector<float> values(static_cast<size_t>(rows.size()));
  std::transform(rows.data(), rows.data() + rows.size(), values.begin(),
                 [](double x) { return static_cast<float>(x); });
  return values;
}

// glTF requires the last row of a bind matrix to be exact.
void append_affine(Matrix4 matrix, std::vector<float>& values) {
  matrix.row(3) << 0, 0, 0, 1;
  for (const double x : matrix.reshaped()) values.push_back(static_cast<float>(x));
}

}  // namespace

void SkinData::begin() { writer_.emplace(root_, container_.bin, container_.binary); }

size_t SkinData::add_inverse_binds(const Matrix4& world_transform) {
  std::vector<float> values;
  for (const Joint& joint : rig_.rig->joints) append_affine(joint.bind.inverse() * world_transform, values);
  return writer_->add(values, 16);
}

size_t SkinData::add_binds_as_shown(const Json& joints) {
  const std::vector<Matrix4> world = world_transforms(node_tree(view_.model));
  std::vector<float> values;
  for (const Json& joint : joints) append_affine(world[joint.get<size_t>()].inverse(), values);
  return writer_->add(values, 16);
}

void SkinData::add_weights(const GltfPrimitive& primitive) {
  Json& attributes = primitive_of(primitive)["attributes"];
  const auto remove_set = [&](const std::string& set) {
    return int{remove(attributes, "JOINTS_" + set)} + int{remove(attributes, "WEIGHTS_" + set)} > 0;
  };
  for (int set = 0; remove_set(std::to_string(set)); ++set) {
  }
  add_weight_set(primitive, rig_.rig->influences, 0);
  if (!rig_.rig->more.empty()) add_weight_set(primitive, rig_.rig->more, 1);
}

void SkinData::add_weight_set(const GltfPrimitive& primitive, const std::vector<VertexInfluences>& all,
                              int set) {
  std::vector<uint8_t> narrow;
  std::vector<uint16_t> wide;
  std::vector<float> weights;
  const bool fits = rig_.rig->joints.size() <= 256;
  for (int32_t v = 0; v < primitive.vertex_count; ++v) {
    VertexInfluences influences = all[primitive.first_vertex + v];
    if (set == 0 && !(influences[0].weight > 0))
      influences[0] = {0, 1};  // a vertex of no triangle: glTF requires a sum of 1
    for (const Influence& one : influences) {
      const int32_t joint = one.weight > 0 ? one.joint : 0;
      fits ? narrow.push_back(static_cast<uint8_t>(joint)) : wide.push_back(static_cast<uint16_t>(joint));
      weights.push_back(std::max(one.weight, 0.0f));
    }
  }
  const size_t joints =
      fits ? writer_->add(narrow, 4, ViewTarget::vertices) : writer_->add(wide, 4, ViewTarget::vertices);
  const size_t shares = writer_->add(weights, 4, ViewTarget::vertices);
  Json& attributes = primitive_of(primitive)["attributes"];
  at(attributes, "JOINTS_" + std::to_string(set)) = joints;
  at(attributes, "WEIGHTS_" + std::to_string(set)) = shares;
}

// move(vertex, row) modifies a row.
template <class Move>
void SkinData::replace(Json& attributes, const char* name, bool has_bounds, const Move& move) {
  Json* old = find(attributes, name);
  if (!old) return;
  RowMatrix rows = read_accessor(view_, buffers_, old->get<int64_t>());
  for (Eigen::Index v = 0; v < rows.rows(); ++v) {
    Vector3 moved = move(static_cast<size_t>(v), Vector3(rows.row(v).head<3>().transpose()));
    rows.row(v).head<3>() = moved.transpose();
  }
  const size_t accessor = writer_->add(single(rows), static_cast<int>(rows.cols()), ViewTarget::vertices);
  if (has_bounds) {
    const RowMatrix rounded = rows.cast<float>().cast<double>();
    const Vector3 low = rounded.colwise().minCoeff(), high = rounded.colwise().maxCoeff();
    writer_->put_bounds(accessor, std::span(low.data(), 3), std::span(high.data(), 3));
  }
  *find(attributes, name) = accessor;
}

void SkinData::place_attributes(Json& attributes, const std::vector<Matrix4>& transforms, bool are_offsets) {
  replace(attributes, "POSITION", true, [&](size_t v, const Vector3& p) -> Vector3 {
    return transforms[v].topLeftCorner<3, 3>() * p +
           (are_offsets ? 0.0 : 1.0) * transforms[v].topRightCorner<3, 1>();
  });
  const auto unit = [&](const Vector3& turned) -> Vector3 {
    return are_offsets || !(turned.norm() > 0) ? turned : Vector3(turned.normalized());
  };
  replace(attributes, "NORMAL", false, [&](size_t v, const Vector3& n) -> Vector3 {
    const Matrix3 linear = transforms[v].topLeftCorner<3, 3>();
    const Matrix3 normal = are_offsets ? linear : Matrix3(linear.inverse().transpose());
    return unit(normal.allFinite() ? Vector3(normal * n) : n);
  });
  replace(attributes, "TANGENT", false, [&](size_t v, const Vector3& t) -> Vector3 {
    return unit(transforms[v].topLeftCorner<3, 3>() * t);
  });
}

void SkinData::place_vertices(const GltfPrimitive& primitive) {
  const auto transforms = vertex_transforms(view_, buffers_, primitive);
  place_attributes(primitive_of(primitive)["attributes"], transforms, false);
  if (Json* targets = find(primitive_of(primitive), "targets"))
    for (Json& target : *targets) place_attributes(target, transforms, true);
}

void SkinData::turn_triangles(const GltfPrimitive& primitive) {
  std::vector<uint32_t> indices;
  for (int32_t t = 0; t < primitive.triangle_count; ++t)
    for (int k = 0; k < 3; ++k)
      indices.push_back(static_cast<uint32_t>(rig_.mesh->triangles(primitive.first_triangle + t, k) -
                                              primitive.first_vertex));
  const size_t accessor = writer_->add(indices, 1, ViewTarget::indices);
  Json& element = primitive_of(primitive);
  remove(element, "mode");  // a strip or fan has become a list
  at(element, "indices") = accessor;
}

// The name, or the first of "name (2)", "name (3)", ... that no animation of the file uses.
std::string SkinData::free_animation_name(const std::string& name) {
  std::set<std::string> taken;
  if (Json* animations = find(root_, "animations"); animations && animations->is_array())
    for (Json& one : *animations)
      if (const Json* own = find(one, "name"); own && own->is_string()) taken.insert(own->get<std::string>());
  std::string free = name;
  for (int number = 2; taken.contains(free); ++number) free = name + " (" + std::to_string(number) + ")";
  return free;
}

// Channels with the same times share an accessor, as in most files.
size_t SkinData::times_accessor(const std::vector<double>& times) {
  for (const auto& [known, accessor] : times_)
    if (known == times) return accessor;
  const std::vector<float> values(times.begin(), times.end());
  const size_t accessor = writer_->add(values, 1);
  writer_->put_bounds(accessor, std::span(&times.front(), 1), std::span(&times.back(), 1));
  times_.emplace_back(times, accessor);
  return accessor;
}

void SkinData::add_channel(Json& samplers, Json& channels, size_t node, const char* path, const Keys& keys) {
  if (keys.empty()) return;
  const size_t input = times_accessor(keys.times);
  const size_t output = writer_->add(single(keys.values), static_cast<int>(keys.values.cols()));
  samplers.emplace_back(nullptr);
  Json& sampler = new_object(samplers.back());
  sampler["input"] = input;
  sampler["output"] = output;
  if (keys.interpolation != Interpolation::linear)
    sampler["interpolation"] = keys.interpolation == Interpolation::step ? "STEP" : "CUBICSPLINE";
  channels.emplace_back(nullptr);
  Json& channel = new_object(channels.back());
  channel["sampler"] = samplers.size() - 1;
  Json& target = new_object(channel["target"]);
  target["node"] = node;
  target["path"] = path;
}

void SkinData::add_animation(const JointAnimation& animation, const std::vector<size_t>& joint_node) {
  const auto moves = [](const JointKeys& keys) {
    return !keys.rotation.empty() || !keys.translation.empty();
  };
  if (std::none_of(animation.joints.begin(), animation.joints.end(), moves)) return;
  const std::string name = free_animation_name(animation.name);
  OrderedJsonDocument made;  // complete before it is inserted
  Json& element = new_object(made.root());
  element["name"] = name;
  new_list(element["samplers"]);
  new_list(element["channels"]);
  for (size_t j = 0; j < animation.joints.size(); ++j) {
    Json &samplers = element["samplers"], &channels = element["channels"];
    add_channel(samplers, channels, joint_node[j], "rotation", animation.joints[j].rotation);
    add_channel(samplers, channels, joint_node[j], "translation", animation.joints[j].translation);
  }
  root_["animations"][append_element(root_, "animations")].swap(element);
}

const std::vector<bool>& SkinData::things() {
  if (!things_.empty()) return things_;
  const tiny::Model& model = view_.model;
  const NodeTree tree = node_tree(model);
  std::vector<bool> holds_joint(model.nodes.size());
  things_.assign(model.nodes.size(), false);
  for (const tiny::Skin& skin : model.skins)
    for (const int joint : skin.joints) holds_joint[static_cast<size_t>(joint)] = true;
  for (size_t i = tree.order.size(); i-- > 0;) {
    const auto node = static_cast<size_t>(tree.order[i]);
    Json& now = root_["nodes"][node];
    for (const char* key : {"mesh", "camera", "extensions"})
      if (find(now, key)) things_[node] = true;
    if (const int32_t parent = tree.parent[node]; parent >= 0) {
      if (holds_joint[node]) holds_joint[static_cast<size_t>(parent)] = true;
      if (things_[node]) things_[static_cast<size_t>(parent)] = true;
    }
  }
  for (size_t node = 0; node < things_.size(); ++node)
    if (holds_joint[node]) things_[node] = false;
  return things_;
}

bool SkinData::carries_a_thing(size_t node) { return node < things().size() && things()[node]; }

}  // namespace focal
