// Adds a skeleton and skin weights to the caller's own glTF document.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "base/error.h"
#include "gltf/accessor_writer.h"
#include "gltf/node_references.h"
#include "gltf/opened.h"
#include "gltf/previous_rig.h"
#include "gltf/skin_data.h"
#include "gltf/text.h"

namespace focal {
namespace {

using Json = OrderedJson;

constexpr int32_t max_joints = 65536;  // the range of 16 bits

class SkinInserter {
 public:
  SkinInserter(Json& root, std::span<GltfPrimitive> primitives, const GltfRig& rig, SkinData& data)
      : root_(root), primitives_(primitives), rig_(rig), data_(data), pool_(root) {}

  void add();

 private:
  void add_joint_nodes();
  void hang_over(size_t joint);
  size_t skin_for(const Matrix4& world_transform);
  size_t place_skin();
  void give_own_meshes();
  bool is_animated(int32_t node);
  size_t new_carrier(const GltfPrimitive& primitive);
  size_t attach(const GltfPrimitive& primitive, size_t skin);
  void attach_all();
  void retire_former_skins(size_t count);
  Json& nodes() { return member_or_new(root_, "nodes", Json::value_t::array); }

  Json& root_;
  std::span<GltfPrimitive> primitives_;
  const GltfRig& rig_;
  SkinData& data_;
  NodePool pool_;
  std::vector<size_t> free_skins_;  // of an earlier call
  std::vector<size_t> joint_node_;
  std::vector<std::pair<Matrix4, size_t>> skins_;
  std::vector<std::vector<ChannelTarget>> animated_;  // per animation of the file
  MovedNodes moved_;
};

void put_place(Json& node, const Matrix4& place) {
  put_vector(node, "translation", place.topRightCorner<3, 1>());
  const Eigen::Quaterniond q(Matrix3(place.topLeftCorner<3, 3>()));
  put_numbers(node, "rotation", std::span(q.coeffs().data(), 4));
}

Json::array_t& children_of(Json& node) {
  return member_or_new(node, "children", Json::value_t::array).get_ref<Json::array_t&>();
}

Json& mark(Json& node) {
  Json& extras = member_or_new(node, "extras", Json::value_t::object);
  return member_or_new(extras, "focal", Json::value_t::object);
}

// One node per joint, below one root: glTF requires a common root in the scene. A tip is a node that is not
// in the skin.
void SkinInserter::add_joint_nodes() {
  const auto& joints = rig_.rig->joints;
  const size_t armature = pool_.take();
  for (size_t j = 0; j < joints.size(); ++j) joint_node_.push_back(pool_.take());
  std::vector<bool> is_leaf(joints.size(), true);
  for (size_t j = 0; j < joints.size(); ++j) {
    const auto stands = [&](size_t joint) {
      return rig_.pose.empty() ? joints[joint].bind : rig_.pose[joint];
    };
    const int32_t parent = joints[j].parent;
    Json& node = nodes()[joint_node_[j]];
    at(node, "name") = joints[j].name;
    put_place(node,
              parent < 0 ? stands(j) : Matrix4(stands(static_cast<size_t>(parent)).inverse() * stands(j)));
    children_of(nodes()[parent < 0 ? armature : joint_node_[static_cast<size_t>(parent)]])
        .emplace_back(joint_node_[j]);
    if (parent >= 0) is_leaf[static_cast<size_t>(parent)] = false;
  }
  for (size_t j = 0; j < joints.size(); ++j) {
    if (is_leaf[j] && !rig_.tips.empty()) {
      const size_t tip = pool_.take();
      put_vector(nodes()[tip], "translation",
                 (joints[j].bind.inverse() * rig_.tips[j].homogeneous()).head<3>());
      at(nodes()[tip], "name") = joints[j].name + "_tip";
      at(mark(nodes()[tip]), "tip") = true;
      children_of(nodes()[joint_node_[j]]).emplace_back(tip);
    }
  }
  at(nodes()[armature], "name") = "focal_skeleton";
  at(mark(nodes()[armature]), "version") = 1;
  // First in the scene: three.js renames the later of two nodes with one name.
  auto& shown = member_or_new(shown_scene(root_), "nodes", Json::value_t::array).get_ref<Json::array_t&>();
  shown.emplace(shown.begin(), armature);
}

// Moves other children of the joint that this one replaces (a sword, a lamp, a camera) to this one, without
// changing their world transform.
void SkinInserter::hang_over(size_t joint) {
  if (rig_.replaces.empty() || rig_.replaces[joint].node < 0) return;
  const int64_t former = rig_.replaces[joint].node;
  moved_.joints[former] = static_cast<int64_t>(joint_node_[joint]);
  Json* children = find(nodes()[former], "children");
  if (!children) return;
  std::vector<size_t> things;
  for (const Json& child : *children)
    if (data_.carries_a_thing(child.get<size_t>())) things.push_back(child.get<size_t>());
  if (things.empty()) return;
  auto& list = children->get_ref<Json::array_t&>();
  list.erase(std::remove_if(list.begin(), list.end(),
                            [&](const Json& child) {
                              return std::count(things.begin(), things.end(), child.get<size_t>());
                            }),
             list.end());
  if (list.empty()) remove(nodes()[former], "children");
  const Matrix4 place = rig_.rig->joints[joint].bind.inverse() * rig_.replaces[joint].bind;
  const size_t holder = append_element(root_, "nodes");
  Json& node = nodes()[holder];
  at(node, "name") = rig_.rig->joints[joint].name + "_things";
  put_numbers(node, "matrix", std::span(place.data(), 16));
  for (const size_t thing : things) children_of(nodes()[holder]).emplace_back(thing);
  children_of(nodes()[joint_node_[joint]]).emplace_back(holder);
}

// The inverse bind matrices include the mesh's transform, which glTF ignores on a skinned node: one skin per
// transform.
size_t SkinInserter::skin_for(const Matrix4& world_transform) {
  for (const auto& [transform, skin] : skins_)
    if (transform == world_transform) return skin;
  const size_t matrices = data_.add_inverse_binds(world_transform);
  const size_t skin = place_skin();
  Json& element = root_["skins"][skin];
  at(element, "inverseBindMatrices") = matrices;
  Json& list = new_list(at(element, "joints"));
  for (const size_t node : joint_node_) list.push_back(node);
  skins_.emplace_back(world_transform, skin);
  return skin;
}

size_t SkinInserter::place_skin() {
  if (free_skins_.empty()) return append_element(root_, "skins");
  const size_t skin = free_skins_.back();
  free_skins_.pop_back();
  new_object(root_["skins"][skin]);
  return skin;
}

// Each instance gets a mesh of its own, since its weights are its own; other users of the mesh (another
// scene, scenery) keep the original.
void SkinInserter::give_own_meshes() {
  std::map<int32_t, std::set<int32_t>> shown_by;  // mesh -> nodes that are rigged
  for (const GltfPrimitive& primitive : primitives_)
    if (!primitive.is_scenery) shown_by[primitive.mesh].insert(primitive.node);
  std::map<int32_t, size_t> spare;
  std::map<int32_t, int32_t> own;  // node -> mesh
  for (size_t n = 0; n < nodes().size(); ++n) {
    const Json* shown = find(nodes()[n], "mesh");
    const auto rigged = shown ? shown_by.find(shown->get<int32_t>()) : shown_by.end();
    const auto node = static_cast<int32_t>(n);
    if (rigged == shown_by.end() || *rigged->second.begin() == node) continue;
    const auto mesh = static_cast<size_t>(rigged->first);
    size_t copy = 0;
    if (rigged->second.contains(node)) {
      copy = append_copy(root_, "meshes", mesh);
      own[node] = static_cast<int32_t>(copy);
    } else {
      const auto [place, is_new] = spare.try_emplace(rigged->first, 0);
      if (is_new) place->second = append_copy(root_, "meshes", mesh);
      copy = place->second;
    }
    nodes()[n]["mesh"] = copy;
  }
  for (GltfPrimitive& primitive : primitives_)
    if (const auto mesh = own.find(primitive.node); !primitive.is_scenery && mesh != own.end())
      primitive.mesh = mesh->second;
}

bool SkinInserter::is_animated(int32_t node) {
  return std::any_of(animated_.begin(), animated_.end(), [&](const auto& targets) {
    return std::any_of(targets.begin(), targets.end(),
                       [&](const ChannelTarget& one) { return one.node == node && one.path != "weights"; });
  });
}

// A new scene root that takes over the mesh of its node, if there is one.
size_t SkinInserter::new_carrier(const GltfPrimitive& primitive) {
  const size_t carrier = append_element(root_, "nodes");
  at(nodes()[carrier], "name") = "mesh" + std::to_string(primitive.mesh);
  at(nodes()[carrier], "mesh") = primitive.mesh;
  if (primitive.node >= 0) {
    Json& node = nodes()[primitive.node];
    if (const Json* own = find(node, "name"); own && own->is_string())
      nodes()[carrier]["name"] = own->get<std::string>();
    if (Json* weights = find(node, "weights")) at(nodes()[carrier], "weights").swap(*weights);
    for (const char* key : {"mesh", "skin", "weights"}) remove(node, key);
    moved_.meshes[primitive.node] = static_cast<int64_t>(carrier);
  }
  member_or_new(shown_scene(root_), "nodes", Json::value_t::array).push_back(carrier);
  return carrier;
}

// The mesh's node gets the skin if it is a root without a transform.
size_t SkinInserter::attach(const GltfPrimitive& primitive, size_t skin) {
  auto carrier = static_cast<size_t>(primitive.node);
  bool may_carry = primitive.node >= 0 && !is_animated(primitive.node);
  if (may_carry) {
    const Json& roots = member_or_new(shown_scene(root_), "nodes", Json::value_t::array);
    may_carry = std::any_of(roots.begin(), roots.end(),
                            [&](const Json& n) { return n.get<int32_t>() == primitive.node; });
    for (const char* key : {"matrix", "translation", "rotation", "scale"})
      may_carry = may_carry && !find(nodes()[primitive.node], key);
  }
  if (!may_carry) carrier = new_carrier(primitive);
  at(nodes()[carrier], "skin") = skin;
  return carrier;
}

void SkinInserter::attach_all() {
  std::map<std::pair<int32_t, int32_t>, size_t> carriers;  // by mesh and node
  for (GltfPrimitive& primitive : primitives_) {
    if (primitive.is_scenery) continue;
    const auto [carrier, is_new] = carriers.try_emplace({primitive.mesh, primitive.node}, 0);
    if (is_new)
      carrier->second = attach(
          primitive, skin_for(primitive.is_posed ? Matrix4(Matrix4::Identity()) : primitive.world_transform));
  }
  for (GltfPrimitive& primitive : primitives_)
    if (!primitive.is_scenery)
      primitive.node = static_cast<int32_t>(carriers.at({primitive.mesh, primitive.node}));
}

// Skins that are no longer used are kept, since their joints may move something else, but without the
// optional root: it is wrong in many files (Blender's older exporter), and nothing reads it now.
void SkinInserter::retire_former_skins(size_t count) {
  std::vector<bool> used(count);
  for (Json& node : nodes())
    if (const Json* skin = find(node, "skin"); skin && skin->get<size_t>() < count)
      used[skin->get<size_t>()] = true;
  for (size_t skin = 0; skin < count; ++skin)
    if (!used[skin]) remove(root_["skins"][skin], "skeleton");
}

void SkinInserter::add() {
  const Json* former = find(root_, "skins");
  const size_t former_skins = former ? former->size() : 0;
  FormerRig rig = release_previous_rig(root_);
  free_skins_ = rig.skins;
  pool_.release(rig.nodes);
  if (Json* animations = find(root_, "animations"); animations && animations->is_array())
    for (Json& animation : *animations) animated_.push_back(channel_targets(animation));
  data_.begin();
  give_own_meshes();
  add_joint_nodes();
  for (GltfPrimitive& primitive : primitives_) {
    if (primitive.is_scenery) continue;
    data_.add_weights(primitive);
    if (primitive.is_posed) data_.place_vertices(primitive);
    if (primitive.mirrored) data_.turn_triangles(primitive);
    primitive.mirrored = false;
  }
  attach_all();
  for (size_t j = 0; j < joint_node_.size(); ++j) hang_over(j);
  if (skins_.empty()) free_skins_.clear();
  for (const size_t skin : free_skins_) {  // unused, but it must still refer to joints
    new_object(root_["skins"][skin]);
    Json& list = new_list(at(root_["skins"][skin], "joints"));
    for (const size_t node : joint_node_) list.push_back(node);
  }
  retire_former_skins(former_skins);
  move_references(root_, moved_);
  for (const JointAnimation& animation : rig_.animations) data_.add_animation(animation, joint_node_);
}

void check(std::span<const GltfPrimitive> primitives, const GltfRig& rig) {
  const auto joints = rig.rig->joints.size();
  size_t vertices = 0;
  for (const GltfPrimitive& primitive : primitives)
    vertices =
        std::max<size_t>(vertices, static_cast<size_t>(primitive.first_vertex) + primitive.vertex_count);
  const auto suits = [&](const auto& one_a_joint) {
    return one_a_joint.empty() || one_a_joint.size() == joints;
  };
  if (joints == 0 || joints > max_joints || vertices != rig.rig->influences.size() || !suits(rig.tips) ||
      !suits(rig.pose) || !suits(rig.replaces))
    throw Error(Status::invalid_argument, "the rig does not suit the mesh",
                "pass the rig made for this mesh");
  if (!rig.mesh && std::any_of(primitives.begin(), primitives.end(),
                               [](const GltfPrimitive& primitive) { return primitive.mirrored; }))
    throw Error(Status::invalid_argument, "a mirrored mesh needs its triangles", "pass GltfRig.mesh");
  for (const Matrix4& place : rig.pose)
    if (!place.cast<float>().allFinite())
      throw Error(Status::invalid_argument, "a joint's pose is not finite", "pass rigid poses");
  for (const Joint& joint : rig.rig->joints)
    if (!joint.bind.cast<float>().allFinite())
      throw Error(Status::invalid_argument, "joint '" + printable(joint.name) + "' is not finite",
                  "scale the mesh");
}

}  // namespace

void GltfDocument::add_skin(std::span<GltfPrimitive> primitives, const GltfRig& rig) {
  check(primitives, rig);
  Edited& edited = this->edited();
  SkinData data(edited.document.root(), rig, opened_->view, opened_->buffers(), opened_->container);
  SkinInserter(edited.document.root(), primitives, rig, data).add();
  edited.bin = data.finish();
}

}  // namespace focal
