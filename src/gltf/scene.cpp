// Which meshes the file shows, and where: iterative, since nodes may be nested as deep as there are nodes.
#include "gltf/scene.h"

#include <algorithm>
#include <map>

#include "gltf/accessor.h"
#include "gltf/fields.h"
#include "gltf/text.h"

namespace focal {
namespace {

using nlohmann::json;

template <int kSize>
Eigen::Matrix<double, kSize, 1> numbers(const json& node, const char* key,
                                        const Eigen::Matrix<double, kSize, 1>& fallback) {
  const json* values = member(node, key);
  if (!values) return fallback;
  Eigen::Matrix<double, kSize, 1> result;
  for (int i = 0; i < kSize; ++i) result(i) = (*values)[static_cast<size_t>(i)].get<double>();
  return result;
}

Matrix4 matrix_of(const NodePose& pose) {
  Eigen::Quaterniond rotation = pose.rotation.normalized();
  if (!rotation.coeffs().allFinite()) rotation = Eigen::Quaterniond::Identity();
  Matrix4 transform = Matrix4::Identity();
  transform.topLeftCorner<3, 3>() = rotation.toRotationMatrix() * pose.scale.asDiagonal();
  transform.topRightCorner<3, 1>() = pose.translation;
  return transform;
}

Matrix4 local_transform(const json& node) {
  if (!member(node, "matrix")) return matrix_of(pose_of(node));
  const Matrix4 identity = Matrix4::Identity();
  return numbers<16>(node, "matrix", identity.reshaped()).reshaped(4, 4);
}

// The node forest, with everything that depends on ancestors computed once: 10^6 nodes may form one chain.
class Nodes {
 public:
  // poses: of nodes that are shown otherwise than the file has them.
  explicit Nodes(const json& root, const std::map<int32_t, NodePose>& poses = {});

  const json& operator[](int32_t node) const { return nodes_[static_cast<size_t>(node)]; }
  const Matrix4& world_transform(int32_t node) const { return world_[static_cast<size_t>(node)]; }
  int32_t depth(int32_t node) const { return depth_[static_cast<size_t>(node)]; }
  // It or a node above it is not visible.
  bool is_hidden(int32_t node) const { return hidden_[static_cast<size_t>(node)]; }
  // It or a node above it is a joint of a skin.
  bool hangs_on_joint(int32_t node) const { return on_joint_[static_cast<size_t>(node)]; }
  std::string name(int32_t node) const;
  const std::vector<int32_t>& roots() const { return roots_; }
  // The nodes with a mesh at or below `start`: parents first, children in their order.
  std::vector<int32_t> with_mesh_below(const std::vector<int32_t>& start) const;

 private:
  std::vector<int32_t> depth_first(const std::vector<int32_t>& start) const;

  const json& nodes_;
  std::vector<int32_t> roots_;
  std::vector<int32_t> depth_;
  std::vector<Matrix4> world_;
  std::vector<bool> hidden_, on_joint_;
};

bool hides(const json& node) {
  const json* visibility = extension(node, "KHR_node_visibility");
  const json* visible = visibility ? member(*visibility, "visible") : nullptr;
  return visible && !visible->get<bool>();
}

Nodes::Nodes(const json& root, const std::map<int32_t, NodePose>& poses)
    : nodes_(list(root, "nodes")),
      depth_(nodes_.size(), 0),
      world_(nodes_.size()),
      hidden_(nodes_.size()),
      on_joint_(nodes_.size()) {
  std::vector<bool> is_child(nodes_.size());
  for (const json& node : nodes_)
    for (const json& child : list(node, "children")) is_child[child.get<size_t>()] = true;
  for (size_t node = 0; node < is_child.size(); ++node)
    if (!is_child[node]) roots_.push_back(static_cast<int32_t>(node));
  const auto local = [&](int32_t node) {
    const auto posed = poses.find(node);
    return posed == poses.end() ? local_transform((*this)[node]) : matrix_of(posed->second);
  };
  for (const int32_t node : roots_) world_[static_cast<size_t>(node)] = local(node);
  for (size_t node = 0; node < nodes_.size(); ++node) hidden_[node] = hides(nodes_[node]);
  for (const json& skin : list(root, "skins"))
    for (const json& joint : skin["joints"]) on_joint_[joint.get<size_t>()] = true;
  for (const int32_t node : depth_first(roots_))
    for (const json& entry : list((*this)[node], "children")) {
      const auto child = entry.get<size_t>();
      world_[child] = world_transform(node) * local(static_cast<int32_t>(child));
      depth_[child] = depth(node) + 1;
      if (is_hidden(node)) hidden_[child] = true;
      if (hangs_on_joint(node)) on_joint_[child] = true;
    }
}

std::string Nodes::name(int32_t node) const {
  const json* name = member((*this)[node], "name");
  return name && name->is_string() ? "node '" + printable(name->get_ref<const std::string&>()) + "'"
                                   : "node " + std::to_string(node);
}

std::vector<int32_t> Nodes::depth_first(const std::vector<int32_t>& start) const {
  std::vector<int32_t> order, open(start.rbegin(), start.rend());
  std::vector<bool> seen(nodes_.size());  // a scene may name a node twice, or a node and its child
  while (!open.empty()) {
    const int32_t node = open.back();
    open.pop_back();
    if (seen[static_cast<size_t>(node)]) continue;
    seen[static_cast<size_t>(node)] = true;
    order.push_back(node);
    const json& children = list((*this)[node], "children");
    for (size_t i = children.size(); i-- > 0;) open.push_back(children[i].get<int32_t>());
  }
  return order;
}

std::vector<int32_t> Nodes::with_mesh_below(const std::vector<int32_t>& start) const {
  auto order = depth_first(start);
  std::erase_if(order, [&](int32_t node) { return !member((*this)[node], "mesh"); });
  return order;
}

// Every joint carries the bind pose into the world by (its world transform) * (its inverse bind matrix). In the
// bind pose these agree; in another one the topmost joint places the body as a whole.
Matrix4 skin_transform(const json& root, const Nodes& nodes, int32_t skin, GltfBuffers& buffers,
                       std::vector<std::string>& warnings) {
  const json& entry = list(root, "skins")[static_cast<size_t>(skin)];
  const json& joints = entry["joints"];
  const json* accessor = member(entry, "inverseBindMatrices");
  RowMatrix inverse_bind;
  if (accessor) inverse_bind = read_accessor(root, buffers, accessor->get<int64_t>());
  const auto carried = [&](size_t joint) -> Matrix4 {
    const Matrix4 world = nodes.world_transform(joints[joint].get<int32_t>());
    if (!accessor) return world;
    const Eigen::Matrix<double, 16, 1> columns =
        inverse_bind.row(static_cast<Eigen::Index>(joint)).transpose();
    return world * columns.reshaped(4, 4);
  };
  size_t top = 0;
  const auto depth = [&](size_t joint) { return nodes.depth(joints[joint].get<int32_t>()); };
  for (size_t joint = 1; joint < joints.size(); ++joint)
    if (depth(joint) < depth(top)) top = joint;
  const Matrix4 transform = carried(top);
  constexpr double kSamePose = 1e-2;  // relative; exporters store single precision
  bool posed = false;
  for (size_t joint = 0; joint < joints.size() && !posed; ++joint)
    posed = (carried(joint) - transform).norm() > kSamePose * transform.norm();
  if (posed)
    warnings.push_back(
        "skin " + std::to_string(skin) +
        ": the file shows the character in another pose than its bind pose; the bind pose was taken");
  return transform;
}

void add_roots(const json& scene, std::vector<int32_t>& start) {
  for (const json& node : list(scene, "nodes")) start.push_back(node.get<int32_t>());
}

// The nodes whose meshes count: those of the default scene, else of all scenes, else all there are.
std::vector<int32_t> shown_nodes(const json& root, const Nodes& nodes, std::vector<std::string>& warnings) {
  const json& scenes = list(root, "scenes");
  const json* chosen = member(root, "scene");
  std::vector<int32_t> start;
  if (chosen) {
    add_roots(scenes[chosen->get<size_t>()], start);
    const auto found = nodes.with_mesh_below(start);
    if (!found.empty()) return found;
  }
  start.clear();
  for (const json& scene : scenes) add_roots(scene, start);
  auto found = nodes.with_mesh_below(start);
  if (chosen && !found.empty()) warnings.push_back("the default scene shows no mesh; all scenes were taken");
  if (!found.empty()) return found;
  found = nodes.with_mesh_below(nodes.roots());
  if (!found.empty()) warnings.push_back("no scene shows a mesh; all nodes were taken");
  return found;
}

// Where all is hidden, all of it counts: a file of costumes that a program shows one at a time.
void leave_out_hidden(const Nodes& nodes, std::vector<int32_t>& shown, std::vector<std::string>& hidden,
                      std::vector<std::string>& warnings) {
  const auto is_hidden = [&](int32_t node) { return nodes.is_hidden(node); };
  if (std::none_of(shown.begin(), shown.end(), is_hidden)) return;
  if (std::all_of(shown.begin(), shown.end(), is_hidden)) {
    warnings.push_back("KHR_node_visibility hides every mesh; they were taken as if they were shown");
    return;
  }
  for (const int32_t node : shown) {
    if (!is_hidden(node)) continue;
    hidden.push_back(nodes.name(node));
    warnings.push_back("left out of the analysis: " + hidden.back() +
                       ", which KHR_node_visibility hides; keep_scenery (--keep-scenery) keeps it");
  }
  std::erase_if(shown, is_hidden);
}

}  // namespace

NodePose pose_of(const json& node) {
  return {numbers<3>(node, "translation", Vector3::Zero()),
          Eigen::Quaterniond(numbers<4>(node, "rotation", Eigen::Vector4d::UnitW())),  // x, y, z, w
          numbers<3>(node, "scale", Vector3::Ones())};
}

std::vector<Matrix4> world_transforms(const json& root, const std::map<int32_t, NodePose>& poses) {
  const Nodes nodes(root, poses);
  std::vector<Matrix4> result;
  for (size_t node = 0; node < list(root, "nodes").size(); ++node)
    result.push_back(nodes.world_transform(static_cast<int32_t>(node)));
  return result;
}

ShownMeshes placed_meshes(const json& root, GltfBuffers& buffers, bool hidden_too,
                          std::vector<std::string>& warnings) {
  const Nodes nodes(root);
  const json& meshes = list(root, "meshes");
  std::vector<bool> seen(meshes.size());
  ShownMeshes result;
  int64_t repeats = 0;
  std::map<int32_t, Matrix4> skins;  // a character of many parts shares one
  std::vector<int32_t> shown = shown_nodes(root, nodes, warnings);
  if (!hidden_too) leave_out_hidden(nodes, shown, result.hidden, warnings);
  for (const int32_t node : shown) {
    const auto mesh = nodes[node]["mesh"].get<int32_t>();
    if (seen[static_cast<size_t>(mesh)]) {
      ++repeats;
      continue;
    }
    seen[static_cast<size_t>(mesh)] = true;
    const bool mirrored = nodes.world_transform(node).topLeftCorner<3, 3>().determinant() < 0;
    MeshPlacement placement{nodes.name(node),          mesh, node, nodes.world_transform(node), mirrored,
                            nodes.hangs_on_joint(node)};
    if (const json* skin = member(nodes[node], "skin")) {
      const auto index = skin->get<int32_t>();
      auto found = skins.find(index);
      if (found == skins.end())
        found = skins.emplace(index, skin_transform(root, nodes, index, buffers, warnings)).first;
      placement.world_transform = found->second, placement.is_character = true;
    }
    result.placements.push_back(std::move(placement));
  }
  if (repeats > 0)
    warnings.push_back(std::to_string(repeats) +
                       " further instances of meshes were left out; each comes once");
  if (result.placements.empty() && !meshes.empty()) {
    warnings.push_back("no node shows a mesh; the meshes were taken as they stand");
    for (size_t mesh = 0; mesh < meshes.size(); ++mesh)
      result.placements.push_back({"mesh " + std::to_string(mesh), static_cast<int32_t>(mesh)});
  }
  return result;
}

}  // namespace focal
