#include "gltf/previous_rig.h"

#include <algorithm>

namespace focal {
namespace {

using Json = OrderedJson;

class FormerRigs {
 public:
  explicit FormerRigs(Json& root) : root_(root) {}
  FormerRig release();

 private:
  // The node and its descendants, parents first; empty when the user has attached other nodes.
  std::vector<size_t> bare_tree(size_t top);
  void release_groups();
  void release_skins();
  void release_animations();
  bool is_released(const Json& node) const { return released_[node.get<size_t>()]; }

  Json& root_;
  std::vector<bool> released_;  // per node
  FormerRig result_;
};

std::vector<size_t> FormerRigs::bare_tree(size_t top) {
  std::vector<size_t> tree = {top};
  for (size_t i = 0; i < tree.size(); ++i) {
    Json& node = root_["nodes"][tree[i]];
    if (find(node, "mesh") || find(node, "camera") || find(node, "extensions")) return {};
    if (const Json* children = find(node, "children"))
      for (const Json& child : *children) tree.push_back(child.get<size_t>());
  }
  return tree;
}

void FormerRigs::release_groups() {
  auto& roots = member_or_new(shown_scene(root_), "nodes", Json::value_t::array).get_ref<Json::array_t&>();
  released_.resize(root_["nodes"].size());
  const auto is_former = [&](const Json& index) {
    Json& node = root_["nodes"][index.get<size_t>()];
    const Json* name = find(node, "name");
    if (!name || !is_text(*name, "focal_skeleton") || !focal_extras(node)) return false;
    const auto tree = bare_tree(index.get<size_t>());
    for (const size_t one : tree) released_[one] = true;
    result_.nodes.insert(result_.nodes.end(), tree.begin(), tree.end());
    return !tree.empty();
  };
  roots.erase(std::remove_if(roots.begin(), roots.end(), is_former), roots.end());
}

void FormerRigs::release_skins() {
  Json* skins = find(root_, "skins");
  if (!skins) return;
  for (size_t skin = 0; skin < skins->size(); ++skin) {
    const Json& joints = (*skins)[skin]["joints"];
    if (std::any_of(joints.begin(), joints.end(), [&](const Json& joint) { return is_released(joint); }))
      result_.skins.push_back(skin);
  }
  for (Json& node : root_["nodes"]) {
    const Json* skin = find(node, "skin");
    if (skin && std::count(result_.skins.begin(), result_.skins.end(), skin->get<size_t>()))
      remove(node, "skin");
  }
}

void FormerRigs::release_animations() {
  Json* animations = find(root_, "animations");
  if (!animations || !animations->is_array()) return;
  const auto moves_former_alone = [&](Json& animation) {
    const auto targets = channel_targets(animation);
    return !targets.empty() && std::all_of(targets.begin(), targets.end(), [&](const ChannelTarget& one) {
      return one.node >= 0 && one.node < static_cast<int64_t>(released_.size()) && released_[one.node];
    });
  };
  auto& list = animations->get_ref<Json::array_t&>();
  for (Json& animation : list)
    if (moves_former_alone(animation)) {
      OrderedJsonDocument old;
      animation.swap(old.root());
    }
  list.erase(std::remove_if(list.begin(), list.end(), [](const Json& one) { return one.is_null(); }),
             list.end());
  if (list.empty()) remove(root_, "animations");  // glTF allows no empty list
}

FormerRig FormerRigs::release() {
  release_groups();
  release_skins();
  release_animations();
  return result_;
}

}  // namespace

FormerRig release_previous_rig(OrderedJson& root) { return FormerRigs(root).release(); }

}  // namespace focal
