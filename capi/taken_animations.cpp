#include "taken_animations.h"

#include <algorithm>

#include "base/error.h"
#include "gltf/document.h"

namespace focal {

std::vector<std::string> names_of(const std::vector<Joint>& joints) {
  std::vector<std::string> names;
  for (const Joint& joint : joints) names.push_back(joint.name);
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  constexpr size_t most = 6;
  std::string text;
  for (size_t i = 0; i < std::min(names.size(), most); ++i) text += (i ? ", '" : "'") + names[i] + "'";
  return text + (names.size() > most ? " and " + std::to_string(names.size() - most) + " more" : "");
}

bool moves_joint(const Clip& clip, const std::vector<Joint>& joints) {
  return std::any_of(clip.channels.begin(), clip.channels.end(), [&](const Channel& channel) {
    return std::any_of(joints.begin(), joints.end(),
                       [&](const Joint& joint) { return joint.node == channel.node; });
  });
}

std::vector<JointAnimation> animations_for(const CharacterRig& rig, const PreparedMesh& target,
                                           const MeshObject& character, std::vector<std::string>& warnings) {
  if (!character.document)
    throw Error(Status::invalid_argument, "the character has no glTF file to take animations from",
                "load it with focal_mesh_load_gltf and focal_mesh_params.keep_source_file 1");
  const auto source = character.document->rig(character.primitives);
  if (!source)
    throw Error(Status::invalid_argument, "the character that animations are to come from has no skin",
                "pass a rigged and animated character");
  const GltfAnimations found = character.document->animations();
  warnings.insert(warnings.end(), found.warnings.begin(), found.warnings.end());
  const ClipSource from{source->joints, found.tree};
  std::vector<JointAnimation> result;
  std::vector<std::string> missing, still;
  for (const Clip& clip : found.clips) {
    if (!moves_joint(clip, source->joints)) {
      still.push_back(clip.name);
      continue;
    }
    Retargeted made = retarget(from, clip, rig.rig.joints, rig.rest, target.scale / character.mesh->scale);
    missing = std::move(made.missing);
    result.push_back({clip.name, std::move(made.joints)});
  }
  if (!still.empty())
    warnings.push_back("left out, since they move no joint of the character: " + listed(still));
  if (!result.empty() && missing.size() == rig.rig.joints.size())
    throw Error(
        Status::invalid_argument,
        "no joint of the skeleton (" + listed(missing) + ") is one of the animated character's (" +
            listed(names_of(source->joints)) + ")",
        "joints are matched by name: pass a character of the same skeleton, or of a known convention");
  if (!result.empty() && !missing.empty())
    warnings.push_back("the animations do not move joints that their character lacks: " + listed(missing));
  if (result.empty()) warnings.push_back("the character has no animations");
  return result;
}

}  // namespace focal
