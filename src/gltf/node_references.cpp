#include "gltf/node_references.h"

#include <array>
#include <string>
#include <string_view>

namespace focal {
namespace {

using Json = OrderedJson;
using Map = std::map<int64_t, int64_t>;

// Calls use(value) for each value at a path of members; "*" means each member or element.
template <class Use>
void for_each_at(Json& value, std::string_view path, const Use& use) {
  if (path.empty()) return use(value);
  const size_t end = std::min(path.find('/'), path.size());
  const std::string_view step = path.substr(0, end), rest = path.substr(std::min(end + 1, path.size()));
  if (step == "*") {
    for (Json& element : value) for_each_at(element, rest, use);
  } else if (Json* member = value.is_object() ? find(value, std::string(step).c_str()) : nullptr) {
    for_each_at(*member, rest, use);
  }
}

void renumber(Json& value, const Map& map) {
  if (!value.is_number_integer()) return;
  if (const auto found = map.find(value.get<int64_t>()); found != map.end()) value = found->second;
}

constexpr std::array joint_paths{
    "extensions/VRMC_vrm/humanoid/humanBones/*/node",
    "extensions/VRMC_springBone/colliders/*/node",
    "extensions/VRMC_springBone/springs/*/center",
    "extensions/VRMC_springBone/springs/*/joints/*/node",
    "extensions/VRM/humanoid/humanBones/*/node",
    "extensions/VRM/firstPerson/firstPersonBone",
    "extensions/VRM/secondaryAnimation/boneGroups/*/center",
    "extensions/VRM/secondaryAnimation/boneGroups/*/bones/*",
    "extensions/VRM/secondaryAnimation/colliderGroups/*/node",
    "nodes/*/extensions/VRMC_node_constraint/constraint/*/source",
};
// VRM 0 refers to meshes there, whose numbers do not change.
constexpr std::array mesh_paths{
    "extensions/VRMC_vrm/expressions/*/*/morphTargetBinds/*/node",
    "extensions/VRMC_vrm/firstPerson/meshAnnotations/*/node",
};

void move_pointer(Json& pointer, const Map& meshes) {
  if (!pointer.is_string()) return;
  auto& text = pointer.get_ref<std::string&>();
  for (const auto& [from, to] : meshes) {
    const std::string old = "/nodes/" + std::to_string(from) + "/weights";
    if (text == old || text.starts_with(old + "/")) {
      text.replace(0, old.size(), "/nodes/" + std::to_string(to) + "/weights");
      return;
    }
  }
}

}  // namespace

void move_references(OrderedJson& root, const MovedNodes& moved) {
  for (const char* path : joint_paths)
    for_each_at(root, path, [&](Json& value) { renumber(value, moved.joints); });
  for (const char* path : mesh_paths)
    for_each_at(root, path, [&](Json& value) { renumber(value, moved.meshes); });
  for_each_at(root, "animations/*/channels/*/target", [&](Json& target) {
    if (!target.is_object()) return;
    const Json* path = find(target, "path");
    Json* node = find(target, "node");
    if (path && node && is_text(*path, "weights")) renumber(*node, moved.meshes);
    for_each_at(target, "extensions/KHR_animation_pointer/pointer",
                [&](Json& pointer) { move_pointer(pointer, moved.meshes); });
  });
}

}  // namespace focal
