// Finds the meshes that the file shows, and their transforms: iterative, since nodes may be nested as deep as
// there are nodes.
#include "gltf/scene.h"

#include <algorithm>
#include <map>

#include "gltf/accessor.h"
#include "gltf/text.h"

namespace focal {
namespace {

template <int component_count>
Eigen::Matrix<double, component_count, 1> numbers(const std::vector<double>& values,
                                                  const Eigen::Matrix<double, component_count, 1>& fallback) {
  return values.empty() ? fallback
                        : Eigen::Matrix<double, component_count, 1>(
                              Eigen::Map<const Eigen::Matrix<double, component_count, 1>>(values.data()));
}

NodePose pose_of(const tiny::Node& node) {
  return {numbers<3>(node.translation, Vector3::Zero()),
          Eigen::Quaterniond(numbers<4>(node.rotation, Eigen::Vector4d::UnitW())),  // x, y, z, w
          numbers<3>(node.scale, Vector3::Ones())};
}

// The nodes at and below `start`: parents first, children in their order.
std::vector<int32_t> depth_first(const tiny::Model& model, const std::vector<int32_t>& start) {
  std::vector<int32_t> order, open(start.rbegin(), start.rend());
  std::vector<bool> seen(model.nodes.size());  // a scene may list a node twice, or a node and its child
  while (!open.empty()) {
    const int32_t node = open.back();
    open.pop_back();
    if (seen[static_cast<size_t>(node)]) continue;
    seen[static_cast<size_t>(node)] = true;
    order.push_back(node);
    const auto& children = model.nodes[static_cast<size_t>(node)].children;
    open.insert(open.end(), children.rbegin(), children.rend());
  }
  return order;
}

std::vector<int32_t> roots_of(const std::vector<int32_t>& parent) {
  std::vector<int32_t> roots;
  for (size_t node = 0; node < parent.size(); ++node)
    if (parent[node] < 0) roots.push_back(static_cast<int32_t>(node));
  return roots;
}

bool hides(const tiny::Node& node) {
  const tiny::Value* visibility = extension(node.extensions, "KHR_node_visibility");
  if (!visibility || !visibility->IsObject() || !visibility->Has("visible")) return false;
  return !visibility->Get("visible").Get<bool>();
}

// The node forest, with everything that depends on ancestors computed once: 10^6 nodes may form one chain.
class Nodes {
 public:
  explicit Nodes(const tiny::Model& model);

  const tiny::Model& model;
  const NodeTree tree;
  const std::vector<Matrix4> world;
  std::vector<bool> is_hidden;       // the node or one above it is hidden
  std::vector<bool> hangs_on_joint;  // the node or one above it is a joint of a skin
  std::string name(int32_t node) const;
  std::vector<int32_t> with_mesh_below(const std::vector<int32_t>& start) const;
};

Nodes::Nodes(const tiny::Model& from)
    : model(from),
      tree(node_tree(from)),
      world(world_transforms(tree)),
      is_hidden(from.nodes.size()),
      hangs_on_joint(from.nodes.size()) {
  for (const tiny::Skin& skin : model.skins)
    for (const int joint : skin.joints) hangs_on_joint[static_cast<size_t>(joint)] = true;
  for (const int32_t node : tree.order) {
    const int32_t above = tree.parent[node];
    is_hidden[node] = hides(model.nodes[node]) || (above >= 0 && is_hidden[above]);
    if (above >= 0 && hangs_on_joint[above]) hangs_on_joint[node] = true;
  }
}

std::string Nodes::name(int32_t node) const {
  const std::string& name = model.nodes[static_cast<size_t>(node)].name;
  return name.empty() ? "node " + std::to_string(node) : "node '" + printable(name) + "'";
}

std::vector<int32_t> Nodes::with_mesh_below(const std::vector<int32_t>& start) const {
  auto order = depth_first(model, start);
  std::erase_if(order, [&](int32_t node) { return model.nodes[static_cast<size_t>(node)].mesh < 0; });
  return order;
}

// The nodes whose meshes are read: those of the default scene, else of all scenes, else all nodes.
std::vector<int32_t> shown_nodes(const Nodes& nodes, std::vector<std::string>& warnings) {
  const auto& scenes = nodes.model.scenes;
  const int chosen = nodes.model.defaultScene;
  if (chosen >= 0) {
    const auto found = nodes.with_mesh_below(scenes[static_cast<size_t>(chosen)].nodes);
    if (!found.empty()) return found;
  }
  std::vector<int32_t> start;
  for (const tiny::Scene& scene : scenes) start.insert(start.end(), scene.nodes.begin(), scene.nodes.end());
  auto found = nodes.with_mesh_below(start);
  if (chosen >= 0 && !found.empty())
    warnings.push_back("the default scene shows no mesh; all scenes are used");
  if (!found.empty()) return found;
  found = nodes.with_mesh_below(roots_of(nodes.tree.parent));
  if (!found.empty()) warnings.push_back("no scene shows a mesh; all nodes are used");
  return found;
}

// If everything is hidden, everything is read: a file of costumes that a program shows one at a time.
void leave_out_hidden(const Nodes& nodes, std::vector<int32_t>& shown, std::vector<std::string>& hidden,
                      std::vector<std::string>& warnings) {
  const auto is_hidden = [&](int32_t node) { return nodes.is_hidden[static_cast<size_t>(node)]; };
  if (std::none_of(shown.begin(), shown.end(), is_hidden)) return;
  if (std::all_of(shown.begin(), shown.end(), is_hidden)) {
    warnings.push_back("KHR_node_visibility hides every mesh; all are used");
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

// Whether joints at different positions are all bound in one position.
bool makes_no_shape(const SkinPlace& place, const std::vector<Matrix4>& world,
                    const std::vector<int>& joints) {
  constexpr double one_place = 1e-3;  // relative to the skeleton's size
  Eigen::AlignedBox3d bound, shown;
  for (size_t j = 0; j < joints.size(); ++j) {
    const Matrix4 bind = place.transform * place.inverse_bind[j].inverse();
    if (!bind.allFinite()) return false;
    bound.extend(Vector3(bind.topRightCorner<3, 1>()));
    shown.extend(Vector3(world[static_cast<size_t>(joints[j])].topRightCorner<3, 1>()));
  }
  return bound.diagonal().norm() < one_place * shown.diagonal().norm();
}

// The transforms of the skins that shown nodes use.
std::map<int32_t, SkinPlace> worn_skins(const GltfView& view, GltfBuffers& buffers, const Nodes& nodes,
                                        const std::vector<int32_t>& shown,
                                        std::vector<std::string>& warnings) {
  std::map<int32_t, SkinPlace> skins;
  for (const int32_t node : shown) {
    const int32_t skin = nodes.model.nodes[static_cast<size_t>(node)].skin;
    if (skin < 0 || skins.contains(skin)) continue;
    const SkinPlace& place =
        skins.emplace(skin, skin_place(view, buffers, nodes.tree, nodes.world, skin)).first->second;
    if (place.is_posed)
      warnings.push_back("skin " + std::to_string(skin) +
                         ": its bind matrices make no shape; the pose that the file shows is used");
    else if (place.is_other_pose)
      warnings.push_back(
          "skin " + std::to_string(skin) +
          ": the file shows the character in another pose than its bind pose; the bind pose is used");
  }
  return skins;
}

// For each node the joint of a used skin that it is or is below: the skin, and the index of the joint; -1 for
// none.
std::vector<std::pair<int32_t, int32_t>> joints_above(const Nodes& nodes,
                                                      const std::map<int32_t, SkinPlace>& skins) {
  std::vector<std::pair<int32_t, int32_t>> result(nodes.world.size(), {-1, -1});
  for (const auto& [skin, place] : skins) {
    const auto& joints = nodes.model.skins[static_cast<size_t>(skin)].joints;
    for (size_t j = 0; j < joints.size(); ++j)
      if (auto& found = result[static_cast<size_t>(joints[j])]; found.first < 0)
        found = {skin, static_cast<int32_t>(j)};
  }
  for (const int32_t node : nodes.tree.order)
    if (const int32_t above = nodes.tree.parent[node]; above >= 0 && result[node].first < 0)
      result[node] = result[above];
  return result;
}

// Moves a mesh below a joint to where the bind pose has that joint.
void hang_on_joint(const Nodes& nodes, const SkinPlace& place, int32_t skin, int32_t joint,
                   MeshPlacement& placement) {
  const int32_t node = nodes.model.skins[static_cast<size_t>(skin)].joints[static_cast<size_t>(joint)];
  const Matrix4 moved =
      place.bind(static_cast<size_t>(joint)) * nodes.world[node].inverse() * placement.world_transform;
  if (moved.allFinite()) placement.world_transform = moved, placement.joint = node;
}

MeshPlacement placement_of(const Nodes& nodes, int32_t node, const std::map<int32_t, SkinPlace>& skins,
                           const std::pair<int32_t, int32_t>& joint) {
  const tiny::Node& from = nodes.model.nodes[static_cast<size_t>(node)];
  MeshPlacement placement{nodes.name(node), from.mesh, node, nodes.world[node]};
  placement.mirrored = nodes.world[node].topLeftCorner<3, 3>().determinant() < 0;
  placement.is_character = nodes.hangs_on_joint[static_cast<size_t>(node)] || from.skin >= 0;
  placement.skin = from.skin;
  if (from.skin < 0) {
    if (joint.first >= 0) hang_on_joint(nodes, skins.at(joint.first), joint.first, joint.second, placement);
    return placement;
  }
  const SkinPlace& place = skins.at(from.skin);
  placement.is_posed = place.is_posed;
  placement.world_transform = place.is_posed ? Matrix4(Matrix4::Identity()) : place.transform;
  return placement;
}

}  // namespace

NodeTree node_tree(const tiny::Model& model) {
  NodeTree tree;
  tree.parent.assign(model.nodes.size(), -1);
  for (size_t node = 0; node < model.nodes.size(); ++node) {
    const tiny::Node& from = model.nodes[node];
    for (const int child : from.children)
      tree.parent[static_cast<size_t>(child)] = static_cast<int32_t>(node);
    tree.pose.push_back(pose_of(from));
    const Matrix4 identity = Matrix4::Identity();
    tree.local.push_back(from.matrix.empty()
                             ? matrix_of(tree.pose.back())
                             : Matrix4(numbers<16>(from.matrix, identity.reshaped()).reshaped(4, 4)));
  }
  tree.order = depth_first(model, roots_of(tree.parent));
  tree.depth.assign(model.nodes.size(), 0);
  for (const int32_t node : tree.order)
    if (tree.parent[node] >= 0) tree.depth[node] = tree.depth[tree.parent[node]] + 1;
  return tree;
}

Matrix4 SkinPlace::bind(size_t joint) const {
  return (is_posed ? carried[joint] : transform) * inverse_bind[joint].inverse();
}

SkinPlace skin_place(const GltfView& view, GltfBuffers& buffers, const NodeTree& tree,
                     const std::vector<Matrix4>& world, int32_t skin) {
  const tiny::Skin& from = view.model.skins[static_cast<size_t>(skin)];
  SkinPlace place;
  place.inverse_bind.assign(from.joints.size(), Matrix4::Identity());
  if (from.inverseBindMatrices >= 0) {
    const RowMatrix rows = read_accessor(view, buffers, from.inverseBindMatrices);
    for (size_t j = 0; j < from.joints.size(); ++j)
      place.inverse_bind[j] = Eigen::Map<const Matrix4>(rows.row(static_cast<Eigen::Index>(j)).data());
  }
  size_t top = 0;
  for (size_t j = 0; j < from.joints.size(); ++j) {
    place.carried.push_back(world[static_cast<size_t>(from.joints[j])] * place.inverse_bind[j]);
    if (tree.depth[from.joints[j]] < tree.depth[from.joints[top]]) top = j;
  }
  place.transform = place.carried[top];
  constexpr double same_pose = 1e-2;  // relative; exporters store single precision
  for (const Matrix4& carried : place.carried)
    place.is_other_pose |= (carried - place.transform).norm() > same_pose * place.transform.norm();
  place.is_posed = place.is_other_pose && makes_no_shape(place, world, from.joints);
  return place;
}

ShownMeshes placed_meshes(const GltfView& view, GltfBuffers& buffers, bool hidden_too,
                          std::vector<std::string>& warnings) {
  const Nodes nodes(view.model);
  ShownMeshes result;
  std::vector<int32_t> shown = shown_nodes(nodes, warnings);
  if (!hidden_too) leave_out_hidden(nodes, shown, result.hidden, warnings);
  const auto skins = worn_skins(view, buffers, nodes, shown, warnings);
  const auto joints = joints_above(nodes, skins);
  for (const int32_t node : shown)
    result.placements.push_back(placement_of(nodes, node, skins, joints[static_cast<size_t>(node)]));
  if (result.placements.empty() && !view.model.meshes.empty()) {
    warnings.push_back("no node shows a mesh; the meshes are used without a transform");
    for (size_t mesh = 0; mesh < view.model.meshes.size(); ++mesh)
      result.placements.push_back({"mesh " + std::to_string(mesh), static_cast<int32_t>(mesh)});
  }
  return result;
}

}  // namespace focal
