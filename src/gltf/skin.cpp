// Merges a file's skins into one skeleton, and reads the weights of the merged vertices.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "gltf/accessor.h"
#include "gltf/opened.h"
#include "gltf/scene.h"

namespace focal {
namespace {

// The joints of all skins, each node once.
class Skeleton {
 public:
  Skeleton(const GltfView& view, GltfBuffers& buffers)
      : view_(view), buffers_(buffers), tree_(node_tree(view.model)), world_(world_transforms(tree_)) {}

  // The first skin that contains a joint defines its bind transform. Skins that share joints may use
  // different units.
  void add(int32_t skin);
  bool is_empty() const { return binds_.empty(); }
  // Parents before children; order_ maps each node to its index.
  std::vector<Joint> joints();
  int32_t order_of(int32_t node) const { return order_.at(node); }
  bool has(int32_t node) const { return order_.contains(node); }

 private:
  std::string free_name(int32_t node);

  const GltfView& view_;
  GltfBuffers& buffers_;
  NodeTree tree_;
  std::vector<Matrix4> world_;
  std::set<int32_t> added_;
  std::map<int32_t, Matrix4> binds_;
  std::map<int32_t, int32_t> order_;
  std::set<std::string> taken_;
  std::map<std::string, int32_t> names_;  // number of uses of each
};

void Skeleton::add(int32_t skin) {
  if (!added_.insert(skin).second) return;
  const SkinPlace place = skin_place(view_, buffers_, tree_, world_, skin);
  const auto& joints = view_.model.skins[static_cast<size_t>(skin)].joints;
  for (size_t j = 0; j < joints.size(); ++j) {
    const Matrix4 bind = place.bind(j);
    if (!bind.allFinite())
      throw Error(Status::invalid_file, "the bind matrix of joint " + std::to_string(j) + " has no inverse",
                  "apply the scale of the skeleton and export it again");
    binds_.emplace(joints[j], bind);
  }
}

// Joints of different files are matched by name, so names must be unique within one file.
std::string Skeleton::free_name(int32_t node) {
  const std::string& own = view_.model.nodes[static_cast<size_t>(node)].name;
  const std::string base = own.empty() ? "joint" + std::to_string(node) : own;
  int32_t& uses = names_[base];
  std::string name;
  do {
    name = ++uses == 1 ? base : base + " (" + std::to_string(uses) + ")";
  } while (!taken_.insert(name).second);
  return name;
}

std::vector<Joint> Skeleton::joints() {
  std::vector<Joint> result;
  std::vector<int32_t> above(tree_.order.size(), -1);  // per node the joint that it is or is below
  for (const int32_t node : tree_.order) {
    const int32_t parent = tree_.parent[node];
    above[node] = parent < 0 ? -1 : above[parent];
    const auto bind = binds_.find(node);
    if (bind == binds_.end()) continue;
    order_[node] = static_cast<int32_t>(result.size());
    result.push_back({free_name(node), above[node], bind->second, node});
    above[node] = order_[node];
  }
  return result;
}

RowMatrix four_a_vertex(const GltfView& view, GltfBuffers& buffers, int accessor, int32_t vertices) {
  RowMatrix rows = read_accessor(view, buffers, accessor);
  if (rows.rows() < vertices || rows.cols() != 4)
    throw Error(Status::invalid_file, "joints or weights of a primitive are not four per vertex",
                "export the file again");
  return rows;
}

const tiny::Primitive& primitive_of(const GltfView& view, const GltfPrimitive& range) {
  return view.model.meshes[static_cast<size_t>(range.mesh)].primitives[static_cast<size_t>(range.primitive)];
}

}  // namespace

std::vector<std::vector<Influence>> skin_influences(const GltfView& view, GltfBuffers& buffers,
                                                    const GltfPrimitive& range, int64_t& invalid_weights) {
  const auto& attributes = primitive_of(view, range).attributes;
  const size_t joints = view.model.skins[static_cast<size_t>(range.skin)].joints.size();
  std::vector<std::vector<Influence>> all(static_cast<size_t>(range.vertex_count));
  for (int set = 0;; ++set) {
    const auto numbers = attributes.find("JOINTS_" + std::to_string(set));
    const auto weights = attributes.find("WEIGHTS_" + std::to_string(set));
    if (numbers == attributes.end() || weights == attributes.end()) return all;
    const RowMatrix J = four_a_vertex(view, buffers, numbers->second, range.vertex_count);
    const RowMatrix W = four_a_vertex(view, buffers, weights->second, range.vertex_count);
    for (int32_t v = 0; v < range.vertex_count; ++v)
      for (int i = 0; i < 4; ++i) {
        const bool valid = W(v, i) >= 0 && std::isfinite(W(v, i));
        invalid_weights += !valid;
        if (!valid || W(v, i) == 0) continue;
        if (!(J(v, i) >= 0 && J(v, i) < static_cast<double>(joints)))
          throw Error(Status::invalid_file,
                      "vertex " + std::to_string(v) + " of mesh " + std::to_string(range.mesh) +
                          " is moved by a joint that its skin does not have",
                      "export the file again");
        all[v].push_back({static_cast<int32_t>(J(v, i)), static_cast<float>(W(v, i))});
      }
  }
}

std::vector<Matrix4> vertex_transforms(const GltfView& view, GltfBuffers& buffers,
                                       const GltfPrimitive& range) {
  const NodeTree tree = node_tree(view.model);
  const SkinPlace place = skin_place(view, buffers, tree, world_transforms(tree), range.skin);
  int64_t invalid = 0;
  std::vector<Matrix4> result;
  for (const auto& influences : skin_influences(view, buffers, range, invalid)) {
    Matrix4 sum = Matrix4::Zero();
    double total = 0;
    for (const Influence& one : influences) sum += one.weight * place.carried[one.joint], total += one.weight;
    result.push_back(total > 0 ? Matrix4(sum / total) : place.transform);
  }
  return result;
}

std::optional<Rig> GltfDocument::rig(std::span<const GltfPrimitive> primitives,
                                     int64_t* invalid_weights) const {
  const GltfView& view = opened_->view;
  GltfBuffers buffers = opened_->buffers();
  Skeleton skeleton(view, buffers);
  size_t vertices = 0;
  for (const GltfPrimitive& primitive : primitives) {
    vertices =
        std::max<size_t>(vertices, static_cast<size_t>(primitive.first_vertex) + primitive.vertex_count);
    if (primitive.skin >= 0) skeleton.add(primitive.skin);
  }
  if (skeleton.is_empty()) return std::nullopt;
  Rig rig{skeleton.joints(), std::vector<VertexInfluences>(vertices)};
  int64_t invalid = 0;
  for (const GltfPrimitive& primitive : primitives) {
    auto* to = &rig.influences[static_cast<size_t>(primitive.first_vertex)];
    if (primitive.skin >= 0) {
      const auto& joints = view.model.skins[static_cast<size_t>(primitive.skin)].joints;
      for (auto& influences : skin_influences(view, buffers, primitive, invalid)) {
        for (Influence& one : influences)
          one.joint = skeleton.order_of(joints[static_cast<size_t>(one.joint)]);
        *to++ = heaviest(influences);
      }
    } else if (primitive.joint >= 0 && skeleton.has(primitive.joint)) {
      std::fill_n(to, primitive.vertex_count, VertexInfluences{{{skeleton.order_of(primitive.joint), 1}}});
    }
  }
  if (invalid_weights) *invalid_weights = invalid;
  return rig;
}

}  // namespace focal
