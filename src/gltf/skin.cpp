#include "gltf/skin.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "gltf/accessor.h"
#include "gltf/fields.h"

namespace focal {
namespace {

using nlohmann::json;

// The joints of all skins, each node once.
class Skeleton {
 public:
  explicit Skeleton(const json& root) : nodes_(list(root, "nodes")), parent_(nodes_.size(), -1) {
    for (size_t node = 0; node < nodes_.size(); ++node)
      for (const json& child : list(nodes_[node], "children"))
        parent_[child.get<size_t>()] = static_cast<int32_t>(node);
  }

  // bind: from the joint's coordinates to those of the merged mesh. The first skin that names the joint decides.
  void add(int32_t node, const Matrix4& bind) { binds_.emplace(node, bind); }

  // Parents before children; order_of gives each node's place.
  std::vector<Joint> joints() {
    std::vector<Joint> result;
    std::vector<std::pair<int32_t, int32_t>> open;  // a node, and the joint above it
    for (size_t node = nodes_.size(); node-- > 0;)
      if (parent_[node] < 0) open.emplace_back(static_cast<int32_t>(node), -1);
    while (!open.empty()) {
      auto [node, above] = open.back();
      open.pop_back();
      if (const auto bind = binds_.find(node); bind != binds_.end()) {
        order_[node] = static_cast<int32_t>(result.size());
        result.push_back({name_of(node), above, bind->second, node});
        above = order_[node];
      }
      const json& children = list(nodes_[static_cast<size_t>(node)], "children");
      for (size_t i = children.size(); i-- > 0;) open.emplace_back(children[i].get<int32_t>(), above);
    }
    return result;
  }
  int32_t order_of(int32_t node) const { return order_.at(node); }

 private:
  std::string name_of(int32_t node) const {
    const json* name = member(nodes_[static_cast<size_t>(node)], "name");
    return name && name->is_string() && !name->get_ref<const std::string&>().empty()
               ? name->get<std::string>()
               : "joint" + std::to_string(node);
  }

  const json& nodes_;
  std::vector<int32_t> parent_;
  std::map<int32_t, Matrix4> binds_;
  std::map<int32_t, int32_t> order_;
};

const json* skin_of(const json& root, const GltfPrimitive& primitive) {
  if (primitive.node < 0) return nullptr;
  const json* skin = member(list(root, "nodes")[static_cast<size_t>(primitive.node)], "skin");
  return skin ? &list(root, "skins")[skin->get<size_t>()] : nullptr;
}

void add_joints(const json& root, GltfBuffers& buffers, const json& skin, const GltfPrimitive& primitive,
                Skeleton& skeleton) {
  RowMatrix inverse_bind;
  if (const json* accessor = member(skin, "inverseBindMatrices"))
    inverse_bind = read_accessor(root, buffers, accessor->get<int64_t>());
  const json& joints = skin["joints"];
  for (size_t j = 0; j < joints.size(); ++j) {
    Matrix4 inverse = Matrix4::Identity();
    if (inverse_bind.rows() > 0) {
      const Eigen::Matrix<double, 16, 1> columns = inverse_bind.row(static_cast<Eigen::Index>(j)).transpose();
      inverse = columns.reshaped(4, 4);
    }
    const Matrix4 bind = primitive.world_transform * inverse.inverse();
    if (!bind.allFinite())
      throw Error(Status::invalid_file, "the bind matrix of joint " + std::to_string(j) + " has no inverse",
                  "apply the scale of the skeleton and export it again");
    skeleton.add(joints[j].get<int32_t>(), bind);
  }
}

// JOINTS_n and WEIGHTS_n of one primitive, for all n.
void read_influences(const json& root, GltfBuffers& buffers, const json& skin, const GltfPrimitive& range,
                     const Skeleton& skeleton, std::vector<VertexInfluences>& influences,
                     int64_t& invalid_weights) {
  const json& primitive = list(
      root, "meshes")[static_cast<size_t>(range.mesh)]["primitives"][static_cast<size_t>(range.primitive)];
  const json& attributes = primitive["attributes"];
  const json& joints = skin["joints"];
  std::vector<std::vector<Influence>> all(static_cast<size_t>(range.vertex_count));
  for (int set = 0;; ++set) {
    const json* numbers = member(attributes, ("JOINTS_" + std::to_string(set)).c_str());
    const json* weights = member(attributes, ("WEIGHTS_" + std::to_string(set)).c_str());
    if (!numbers || !weights) break;
    const RowMatrix J = read_accessor(root, buffers, numbers->get<int64_t>());
    const RowMatrix W = read_accessor(root, buffers, weights->get<int64_t>());
    // There are as many joints as weights: parse_gltf looks at the attributes of a primitive together.
    if (J.rows() < range.vertex_count || J.cols() != 4 || W.cols() != 4)
      throw Error(Status::invalid_file, "joints or weights of a primitive are not four a vertex",
                  "export the file again");
    for (int32_t v = 0; v < range.vertex_count; ++v)
      for (int i = 0; i < 4; ++i) {
        const bool valid = W(v, i) >= 0 && std::isfinite(W(v, i));
        invalid_weights += !valid;
        if (!valid || W(v, i) == 0) continue;
        if (!(J(v, i) >= 0 && J(v, i) < static_cast<double>(joints.size())))
          throw Error(Status::invalid_file,
                      "vertex " + std::to_string(v) + " of mesh " + std::to_string(range.mesh) +
                          " is moved by a joint that its skin does not have",
                      "export the file again");
        const auto node = joints[static_cast<size_t>(J(v, i))].get<int32_t>();
        all[v].push_back({skeleton.order_of(node), static_cast<float>(W(v, i))});
      }
  }
  for (int32_t v = 0; v < range.vertex_count; ++v)
    influences[static_cast<size_t>(range.first_vertex + v)] = heaviest(all[v]);
}

}  // namespace

std::optional<Rig> read_gltf_rig(std::span<const std::byte> bytes, std::span<const GltfPrimitive> primitives,
                                 const GltfLimits& limits, std::optional<std::filesystem::path> folder,
                                 int64_t* invalid_weights) {
  const GltfContainer container = open_container(bytes, limits);
  const JsonDocument document = parse_gltf(container, limits);
  const json& root = document.root();
  GltfBuffers buffers(root, container, limits, std::move(folder));
  Skeleton skeleton(root);
  bool any = false;
  size_t vertices = 0;
  for (const GltfPrimitive& primitive : primitives) {
    vertices =
        std::max<size_t>(vertices, static_cast<size_t>(primitive.first_vertex) + primitive.vertex_count);
    if (const json* skin = skin_of(root, primitive)) {
      add_joints(root, buffers, *skin, primitive, skeleton);
      any = true;
    }
  }
  if (!any) return std::nullopt;
  Rig rig{skeleton.joints(), std::vector<VertexInfluences>(vertices)};
  int64_t invalid = 0;
  for (const GltfPrimitive& primitive : primitives)
    if (const json* skin = skin_of(root, primitive))
      read_influences(root, buffers, *skin, primitive, skeleton, rig.influences, invalid);
  if (invalid_weights) *invalid_weights = invalid;
  return rig;
}

}  // namespace focal
