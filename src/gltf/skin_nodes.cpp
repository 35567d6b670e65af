// A skeleton and skin weights put into the caller's own glTF document.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "base/error.h"
#include "gltf/document_edit.h"
#include "gltf/former_rig.h"
#include "gltf/glb.h"
#include "gltf/skin_numbers.h"
#include "gltf/text.h"
#include "gltf/writer.h"

namespace focal {
namespace {

using Json = OrderedJson;

constexpr int32_t most_joints = 65536;  // what 16 bits number
constexpr const char *kVertexTarget = "34962", *kIndexTarget = "34963";

template <class T>
void append(std::vector<std::byte>& bytes, const std::vector<T>& values) {
  const auto data = std::as_bytes(std::span(values));
  bytes.insert(bytes.end(), data.begin(), data.end());
}

std::string quaternion_json(const Matrix3& rotation) {
  const Eigen::Quaterniond q(rotation);
  return "[" + json_number(q.x()) + "," + json_number(q.y()) + "," + json_number(q.z()) + "," +
         json_number(q.w()) + "]";
}

class SkinInserter {
 public:
  SkinInserter(Json& root, std::span<const GltfPrimitive> primitives, const GltfRig& rig,
               std::span<const std::byte> bin, bool owns_bin)
      : root_(root),
        primitives_(primitives),
        rig_(rig),
        data_(bin.begin(), bin.end()),
        owns_bin_(owns_bin),
        pool_(root) {}

  void add();
  // Of the primitives whose node has a skin: joint numbers are those of that skin.
  void replace_weights();
  // The BIN chunk of a .glb, the old one included; empty when the data went into a buffer of its own.
  std::vector<std::byte> bin() const { return owns_bin_ ? data_ : std::vector<std::byte>{}; }

 private:
  void begin_data();
  void end_data();
  template <class T>
  size_t add_accessor(const std::vector<T>& values, size_t count, const std::string& format,
                      const char* target = nullptr);
  void add_joint_nodes();
  size_t skin_for(const Matrix4& world_transform);
  size_t place_skin(const std::string& text);
  void add_weights(const GltfPrimitive& primitive);
  void add_weight_set(const GltfPrimitive& primitive, const std::vector<VertexInfluences>& all, int set);
  void turn_triangles(const GltfPrimitive& primitive);
  std::string free_animation_name(const std::string& name);
  void add_animation(const JointAnimation& animation);
  bool is_animated(int32_t node);
  void attach(const GltfPrimitive& primitive, size_t skin);
  void spare_other_instances(int32_t mesh, int32_t node);
  void retire_former_skins(size_t count);
  Json& nodes() { return member_or_new(root_, "nodes", Json::value_t::array); }

  Json& root_;
  std::span<const GltfPrimitive> primitives_;
  const GltfRig& rig_;
  std::vector<std::byte> data_;  // of buffer_, from its beginning
  bool owns_bin_;
  size_t buffer_ = 0;
  NodePool pool_;
  std::vector<size_t> free_skins_;  // of an earlier call
  std::vector<size_t> joint_node_;
  std::vector<std::pair<Matrix4, size_t>> skins_;
};

void SkinInserter::begin_data() {
  Json& buffers = member_or_new(root_, "buffers", Json::value_t::array);
  // Buffer 0 without a URI is the BIN chunk; where it is something else, a buffer of our own is hung behind.
  owns_bin_ = owns_bin_ && (buffers.empty() || !find(buffers[0], "uri"));
  if (owns_bin_ && !buffers.empty()) {
    data_.resize(buffers[0]["byteLength"].get<size_t>());  // without the chunk's padding
    return;
  }
  data_.clear();
  buffer_ = append_element(root_, "buffers", R"({"byteLength":0})");
}

void SkinInserter::end_data() {
  Json& buffer = root_["buffers"][buffer_];
  buffer["byteLength"] = data_.size();
  if (!owns_bin_) buffer["uri"] = "data:application/octet-stream;base64," + base64(data_);
}

template <class T>
size_t SkinInserter::add_accessor(const std::vector<T>& values, size_t count, const std::string& format,
                                  const char* target) {
  data_.resize((data_.size() + 3) / 4 * 4);
  const size_t view = append_element(root_, "bufferViews",
                                     R"({"buffer":)" + std::to_string(buffer_) + R"(,"byteOffset":)" +
                                         std::to_string(data_.size()) + R"(,"byteLength":)" +
                                         std::to_string(values.size() * sizeof(T)) +
                                         (target ? R"(,"target":)" + std::string(target) : "") + "}");
  append(data_, values);
  return append_element(root_, "accessors",
                        R"({"bufferView":)" + std::to_string(view) + R"(,"count":)" + std::to_string(count) +
                            "," + format + "}");
}

// One node a joint, below one root: glTF wants a common root in the scene. A tip is a node without a part in the skin.
void SkinInserter::add_joint_nodes() {
  const auto& joints = rig_.rig->joints;
  std::vector<std::string> children(joints.size());
  std::string roots;
  for (size_t j = 0; j < joints.size(); ++j) {
    joint_node_.push_back(pool_.take());
    std::string& list = joints[j].parent < 0 ? roots : children[joints[j].parent];
    list += (list.empty() ? "" : ",") + std::to_string(joint_node_[j]);
  }
  for (size_t j = 0; j < joints.size(); ++j) {
    if (!children[j].empty() || rig_.tips.empty()) continue;
    const Vector3 tip = (joints[j].bind.inverse() * rig_.tips[j].homogeneous()).head<3>();
    const size_t node = pool_.take();
    put(nodes()[node], R"({"name":)" + json_string(joints[j].name + "_tip") + R"(,"translation":)" +
                           json_array(tip) + R"(,"extras":{"focal":{"tip":true}}})");
    children[j] = std::to_string(node);
  }
  for (size_t j = 0; j < joints.size(); ++j) {
    const auto stands = [&](size_t joint) {
      return rig_.pose.empty() ? joints[joint].bind : rig_.pose[joint];
    };
    Matrix4 local = stands(j);
    if (joints[j].parent >= 0) local = stands(static_cast<size_t>(joints[j].parent)).inverse() * local;
    put(nodes()[joint_node_[j]], R"({"name":)" + json_string(joints[j].name) + R"(,"translation":)" +
                                     json_array(local.topRightCorner<3, 1>()) + R"(,"rotation":)" +
                                     quaternion_json(local.topLeftCorner<3, 3>()) +
                                     (children[j].empty() ? "" : R"(,"children":[)" + children[j] + "]") +
                                     "}");
  }
  const size_t armature = pool_.take();
  put(nodes()[armature],
      R"({"name":"focal_skeleton","children":[)" + roots + R"(],"extras":{"focal":{"version":1}}})");
  // First in the scene: where names are taken twice, three.js renames the later ones.
  auto& shown = member_or_new(shown_scene(root_), "nodes", Json::value_t::array).get_ref<Json::array_t&>();
  shown.insert(shown.begin(), armature);
}

// The inverse bind matrices hold the place of the mesh, which glTF ignores on a skinned node: one skin for each such place.
size_t SkinInserter::skin_for(const Matrix4& world_transform) {
  for (const auto& [transform, skin] : skins_)
    if (transform == world_transform) return skin;
  std::vector<float> inverse_bind;
  std::string list;
  for (size_t j = 0; j < joint_node_.size(); ++j) {
    Matrix4 inverse = rig_.rig->joints[j].bind.inverse() * world_transform;
    inverse.row(3) << 0, 0, 0, 1;
    for (const double x : inverse.reshaped()) inverse_bind.push_back(static_cast<float>(x));
    list += (j ? "," : "") + std::to_string(joint_node_[j]);
  }
  const size_t accessor =
      add_accessor(inverse_bind, joint_node_.size(), R"("componentType":5126,"type":"MAT4")");
  const size_t skin =
      place_skin(R"({"inverseBindMatrices":)" + std::to_string(accessor) + R"(,"joints":[)" + list + "]}");
  skins_.emplace_back(world_transform, skin);
  return skin;
}

size_t SkinInserter::place_skin(const std::string& text) {
  if (free_skins_.empty()) return append_element(root_, "skins", text);
  const size_t skin = free_skins_.back();
  free_skins_.pop_back();
  put(root_["skins"][skin], text);
  return skin;
}

void SkinInserter::add_weights(const GltfPrimitive& primitive) {
  Json& attributes = root_["meshes"][primitive.mesh]["primitives"][primitive.primitive]["attributes"];
  const auto remove_set = [&](const std::string& set) {
    return int{remove(attributes, "JOINTS_" + set)} + int{remove(attributes, "WEIGHTS_" + set)} > 0;
  };
  for (int set = 0; remove_set(std::to_string(set)); ++set) {
  }
  add_weight_set(primitive, rig_.rig->influences, 0);
  if (!rig_.rig->more.empty()) add_weight_set(primitive, rig_.rig->more, 1);
}

void SkinInserter::add_weight_set(const GltfPrimitive& primitive, const std::vector<VertexInfluences>& all,
                                  int set) {
  std::vector<uint8_t> narrow;
  std::vector<uint16_t> wide;
  std::vector<float> weights;
  const bool fits = rig_.rig->joints.size() <= 256;
  for (int32_t v = 0; v < primitive.vertex_count; ++v) {
    VertexInfluences influences = all[primitive.first_vertex + v];
    if (set == 0 && !(influences[0].weight > 0))
      influences[0] = {0, 1};  // a vertex of no triangle: glTF wants a sum of 1
    for (const Influence& one : influences) {
      const int32_t joint = one.weight > 0 ? one.joint : 0;
      fits ? narrow.push_back(static_cast<uint8_t>(joint)) : wide.push_back(static_cast<uint16_t>(joint));
      weights.push_back(std::max(one.weight, 0.0f));
    }
  }
  const auto count = static_cast<size_t>(primitive.vertex_count);
  const size_t joints =
      fits ? add_accessor(narrow, count, R"("componentType":5121,"type":"VEC4")", kVertexTarget)
           : add_accessor(wide, count, R"("componentType":5123,"type":"VEC4")", kVertexTarget);
  const size_t shares = add_accessor(weights, count, R"("componentType":5126,"type":"VEC4")", kVertexTarget);
  Json& attributes = root_["meshes"][primitive.mesh]["primitives"][primitive.primitive]["attributes"];
  const std::string number = std::to_string(set);
  attributes["JOINTS_" + number] = joints, attributes["WEIGHTS_" + number] = shares;
}

// A skin's mesh ignores its node, a mirroring one too: its triangles are turned, so that their outside stays outside.
void SkinInserter::turn_triangles(const GltfPrimitive& primitive) {
  std::vector<uint32_t> indices;
  for (int32_t t = 0; t < primitive.triangle_count; ++t)
    for (int k = 0; k < 3; ++k)
      indices.push_back(static_cast<uint32_t>(rig_.mesh->triangles(primitive.first_triangle + t, k) -
                                              primitive.first_vertex));
  const size_t accessor =
      add_accessor(indices, indices.size(), R"("componentType":5125,"type":"SCALAR")", kIndexTarget);
  Json& element = root_["meshes"][primitive.mesh]["primitives"][primitive.primitive];
  remove(element, "mode");  // a strip or fan is a list now
  element["indices"] = accessor;
}

// The name, or the first of "name (2)", "name (3)", ... that no animation of the file has.
std::string SkinInserter::free_animation_name(const std::string& name) {
  std::set<std::string> taken;
  if (Json* animations = find(root_, "animations"); animations && animations->is_array())
    for (Json& one : *animations)
      if (const Json* own = find(one, "name"); own && own->is_string()) taken.insert(own->get<std::string>());
  std::string free = name;
  for (int number = 2; taken.contains(free); ++number) free = name + " (" + std::to_string(number) + ")";
  return free;
}

void SkinInserter::add_animation(const JointAnimation& animation) {
  const size_t count = animation.times.size();
  if (count == 0) return;
  const std::vector<float> times(animation.times.begin(), animation.times.end());
  const size_t input =
      add_accessor(times, count,
                   R"("componentType":5126,"type":"SCALAR","min":[)" + json_number(times.front()) +
                       R"(],"max":[)" + json_number(times.back()) + "]");
  std::string samplers, channels;
  size_t sampler = 0;
  const auto add_channel = [&](size_t joint, const char* path, const std::vector<float>& values,
                               const char* type) {
    const size_t output =
        add_accessor(values, count, std::string(R"("componentType":5126,"type":")") + type + R"(")");
    const std::string comma = sampler ? "," : "";
    samplers +=
        comma + R"({"input":)" + std::to_string(input) + R"(,"output":)" + std::to_string(output) + "}";
    channels += comma + R"({"sampler":)" + std::to_string(sampler++) + R"(,"target":{"node":)" +
                std::to_string(joint_node_[joint]) + R"(,"path":")" + path + R"("}})";
  };
  for (size_t j = 0; j < animation.joints.size(); ++j) {
    std::vector<float> values;
    for (const Eigen::Quaterniond& q : animation.joints[j].rotation)
      for (int i = 0; i < 4; ++i) values.push_back(static_cast<float>(q.normalized().coeffs()[i]));
    if (!values.empty()) add_channel(j, "rotation", values, "VEC4");
    values.clear();
    for (const Vector3& p : animation.joints[j].translation)
      for (int i = 0; i < 3; ++i) values.push_back(static_cast<float>(p[i]));
    if (!values.empty()) add_channel(j, "translation", values, "VEC3");
  }
  if (sampler > 0)
    append_element(root_, "animations",
                   R"({"name":)" + json_string(free_animation_name(animation.name)) + R"(,"samplers":[)" +
                       samplers + R"(],"channels":[)" + channels + "]}");
}

// Other nodes that show the mesh keep it as it was.
void SkinInserter::spare_other_instances(int32_t mesh, int32_t node) {
  std::optional<size_t> copy;
  for (size_t n = 0; n < nodes().size(); ++n) {
    Json& other = nodes()[n];
    const Json* shown = find(other, "mesh");
    if (static_cast<int32_t>(n) == node || !shown || shown->get<int32_t>() != mesh) continue;
    if (!copy) copy = append_element(root_, "meshes", root_["meshes"][mesh].dump());
    other["mesh"] = *copy;
  }
}

bool SkinInserter::is_animated(int32_t node) {
  Json* animations = find(root_, "animations");
  if (!animations || !animations->is_array()) return false;
  return std::any_of(animations->begin(), animations->end(), [&](Json& animation) {
    const auto targets = channel_targets(animation);
    return std::any_of(targets.begin(), targets.end(),
                       [&](const ChannelTarget& one) { return one.node == node && one.path != "weights"; });
  });
}

// The mesh's node gets the skin when it is a root without a place of its own; else a new root takes the mesh over.
void SkinInserter::attach(const GltfPrimitive& primitive, size_t skin) {
  Json& roots = member_or_new(shown_scene(root_), "nodes", Json::value_t::array);
  std::string name = R"("name":)" + json_string("mesh" + std::to_string(primitive.mesh)) + ",";
  if (primitive.node >= 0) {
    Json& node = nodes()[primitive.node];
    const bool is_root = std::any_of(roots.begin(), roots.end(),
                                     [&](const Json& n) { return n.get<int32_t>() == primitive.node; });
    const bool has_place =
        find(node, "matrix") || find(node, "translation") || find(node, "rotation") || find(node, "scale");
    if (is_root && !has_place && !is_animated(primitive.node)) {
      node["skin"] = skin;
      return;
    }
    const Json* own = find(node, "name");
    if (own && own->is_string()) name = R"("name":)" + json_string(own->get<std::string>()) + ",";
    if (const Json* weights = find(node, "weights")) name += R"("weights":)" + weights->dump() + ",";
    for (const char* key : {"mesh", "skin", "weights"}) remove(node, key);
  }
  roots.push_back(append_element(root_, "nodes",
                                 "{" + name + R"("mesh":)" + std::to_string(primitive.mesh) + R"(,"skin":)" +
                                     std::to_string(skin) + "}"));
}

// Skins that no node uses any more stay, since their joints may move something else, but without the optional root: it is wrong
// in many files (Blender's older exporter), and nobody reads it now.
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
  FormerRig rig = release_former_rig(root_);
  free_skins_ = rig.skins;
  pool_.release(std::move(rig.nodes));
  begin_data();
  add_joint_nodes();
  std::map<int32_t, const GltfPrimitive*> meshes;
  for (const GltfPrimitive& primitive : primitives_)
    if (!primitive.is_scenery && meshes.emplace(primitive.mesh, &primitive).second)
      spare_other_instances(primitive.mesh, primitive.node);
  for (const GltfPrimitive& primitive : primitives_) {
    if (primitive.is_scenery) continue;
    add_weights(primitive);
    if (primitive.mirrored) turn_triangles(primitive);
  }
  for (const auto& [mesh, primitive] : meshes) attach(*primitive, skin_for(primitive->world_transform));
  if (skins_.empty()) free_skins_.clear();
  for (const size_t skin : free_skins_)  // nobody uses it, but what it names must be joints
    root_["skins"][skin] = root_["skins"][skins_.front().second];
  retire_former_skins(former_skins);
  for (const JointAnimation& animation : rig_.animations) add_animation(animation);
  end_data();
}

void SkinInserter::replace_weights() {
  begin_data();
  for (const GltfPrimitive& primitive : primitives_)
    if (skin_of(root_, primitive)) add_weights(primitive);
  end_data();
}

void check(std::span<const GltfPrimitive> primitives, const GltfRig& rig) {
  const auto joints = rig.rig->joints.size();
  size_t vertices = 0;
  for (const GltfPrimitive& primitive : primitives)
    vertices =
        std::max<size_t>(vertices, static_cast<size_t>(primitive.first_vertex) + primitive.vertex_count);
  if (joints == 0 || joints > most_joints || vertices != rig.rig->influences.size() ||
      (!rig.tips.empty() && rig.tips.size() != joints) || (!rig.pose.empty() && rig.pose.size() != joints))
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
      throw Error(Status::invalid_argument, "joint " + json_string(joint.name) + " is not finite",
                  "scale the mesh");
}

}  // namespace

std::vector<std::byte> replace_weights(std::span<const std::byte> source,
                                       std::span<const GltfPrimitive> primitives, const Rig& rig,
                                       const GltfLimits& limits) {
  const GltfContainer container = open_container(source, limits);
  parse_gltf(container, limits);  // every reference followed below is checked here
  OrderedJsonDocument document(container.json, {.depth = limits.json_depth, .values = limits.json_values});
  const Rig of_skins = in_numbers_of_skins(document.root(), primitives, rig);
  const GltfRig given{&of_skins, {}};
  SkinInserter inserter(document.root(), primitives, given, container.bin, container.binary);
  inserter.replace_weights();
  return edited_file(container, document.root(), inserter.bin());
}

std::vector<std::byte> add_skin(std::span<const std::byte> source, std::span<const GltfPrimitive> primitives,
                                const GltfRig& rig, const GltfLimits& limits) {
  check(primitives, rig);
  const GltfContainer container = open_container(source, limits);
  parse_gltf(container, limits);  // every reference followed below is checked here
  OrderedJsonDocument document(container.json, {.depth = limits.json_depth, .values = limits.json_values});
  SkinInserter inserter(document.root(), primitives, rig, container.bin, container.binary);
  inserter.add();
  return edited_file(container, document.root(), inserter.bin());
}

}  // namespace focal
