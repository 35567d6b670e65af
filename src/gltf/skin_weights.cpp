// Replaces the weights of a file's skins: joints and everything else are unchanged, bind matrices too unless
// they are all at one position.
#include <algorithm>
#include <map>

#include "gltf/document_edit.h"
#include "gltf/skin_data.h"

namespace focal {
namespace {

bool has_skin(const GltfPrimitive& primitive) { return primitive.skin >= 0 && !primitive.is_scenery; }

// Per joint of the rig its number in a skin, or that of the nearest joint above it that the skin has; -1:
// neither.
std::vector<int32_t> numbers_in(const OrderedJson& skin, const std::vector<Joint>& joints) {
  std::map<int32_t, int32_t> number;
  int32_t index = 0;
  for (const OrderedJson& node : skin["joints"]) number.emplace(node.get<int32_t>(), index++);
  std::vector<int32_t> result;
  for (const Joint& joint : joints) {
    const auto own = number.find(joint.node);
    result.push_back(own != number.end() ? own->second : joint.parent >= 0 ? result[joint.parent] : -1);
  }
  return result;
}

// Renumbers the influences of a primitive's vertices to the joints of its skin.
void renumber(const GltfPrimitive& primitive, const std::vector<int32_t>& numbers, Rig& rig) {
  const size_t most = (rig.more.empty() ? 1 : 2) * max_influences;
  for (int32_t i = 0; i < primitive.vertex_count; ++i) {
    const auto v = static_cast<size_t>(primitive.first_vertex + i);
    std::vector<Influence> all;
    for (auto* set : {&rig.influences, &rig.more}) {
      if (set->empty()) continue;
      for (const Influence& one : (*set)[v])
        if (one.weight > 0 && numbers[one.joint] >= 0) all.push_back({numbers[one.joint], one.weight});
      (*set)[v] = {};
    }
    all = heaviest(all, most);
    for (size_t k = 0; k < all.size(); ++k)
      (k < max_influences ? rig.influences : rig.more)[v][k % max_influences] = all[k];
  }
}

// A rig with as many joints as the largest of the skins, which determines the integer width of joint numbers.
Rig in_numbers_of_skins(OrderedJson& root, std::span<const GltfPrimitive> primitives, const Rig& rig) {
  Rig result = rig;
  for (const GltfPrimitive& primitive : primitives) {
    if (!has_skin(primitive)) continue;
    const OrderedJson& skin = root["skins"][static_cast<size_t>(primitive.skin)];
    renumber(primitive, numbers_in(skin, rig.joints), result);
    result.joints.resize(std::max(result.joints.size(), skin["joints"].size()));
  }
  return result;
}

// Where all bind matrices are at one position, only the file's own weights hold the mesh together. For other
// weights its vertices are written in the shown pose, with a copy of its skin bound in that pose; other users
// of the skin keep it.
class BindsAsShown {
 public:
  BindsAsShown(OrderedJson& root, SkinData& data) : root_(root), data_(data) {}

  void put(const GltfPrimitive& primitive) {
    data_.place_vertices(primitive);
    const auto [copy, is_new] = copies_.try_emplace(primitive.skin);
    if (is_new) {
      copy->second = append_copy(root_, "skins", static_cast<size_t>(primitive.skin));
      OrderedJson& skin = root_["skins"][copy->second];
      const size_t matrices = data_.add_binds_as_shown(skin["joints"]);
      at(root_["skins"][copy->second], "inverseBindMatrices") = matrices;
    }
    at(root_["nodes"][static_cast<size_t>(primitive.node)], "skin") = copy->second;
  }

 private:
  OrderedJson& root_;
  SkinData& data_;
  std::map<int32_t, size_t> copies_;  // by the skin of the file
};

}  // namespace

void GltfDocument::replace_weights(std::span<const GltfPrimitive> primitives, const Rig& rig) {
  Edited& edited = this->edited();
  const Rig of_skins = in_numbers_of_skins(edited.document.root(), primitives, rig);
  const GltfRig given{&of_skins, {}};
  SkinData data(edited.document.root(), given, opened_->view, opened_->buffers(), opened_->container);
  data.begin();
  BindsAsShown binds(edited.document.root(), data);
  for (const GltfPrimitive& primitive : primitives) {
    if (!has_skin(primitive)) continue;
    if (primitive.is_posed) binds.put(primitive);
    data.add_weights(primitive);
  }
  edited.bin = data.finish();
}

}  // namespace focal
