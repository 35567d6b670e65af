#include "skeleton/taken_animations.h"

#include <algorithm>

#include "base/error.h"
#include "skeleton/joint_match.h"

namespace focal {
namespace {

// "'a', 'b', 'c' and 3 more"
std::string named(const std::vector<std::string>& names) {
  constexpr size_t most = 6;
  return quoted(names, most) +
         (names.size() > most ? " and " + std::to_string(names.size() - most) + " more" : "");
}

// Whether a clip moves a node that is one of these joints.
bool moves_joint(const Clip& clip, const std::vector<Joint>& joints) {
  return std::any_of(clip.channels.begin(), clip.channels.end(), [&](const Channel& channel) {
    return std::any_of(joints.begin(), joints.end(),
                       [&](const Joint& joint) { return joint.node == channel.node; });
  });
}

}  // namespace

std::vector<JointAnimation> animations_for(const CharacterRig& rig, const SourceFile& character, double scale,
                                           std::vector<std::string>& warnings) {
  const auto source = character.document.rig(character.primitives);
  if (!source)
    throw Error(Status::invalid_argument, "the character that animations are to come from has no skin",
                "pass a rigged and animated character");
  const GltfAnimations found = character.document.animations();
  warnings.insert(warnings.end(), found.warnings.begin(), found.warnings.end());
  const ClipSource from{source->joints, found.tree};
  std::vector<JointAnimation> result;
  std::vector<std::string> missing, still;
  for (const Clip& clip : found.clips) {
    if (!moves_joint(clip, source->joints)) {
      still.push_back(clip.name);
      continue;
    }
    Retargeted made = retarget(from, clip, rig.rig.joints, rig.rest, scale);
    missing = std::move(made.missing);
    result.push_back({clip.name, std::move(made.joints)});
  }
  if (!still.empty())
    warnings.push_back("left out, since they move no joint of the character: " + named(still));
  if (result.empty()) {
    warnings.push_back("the character has no animations");
  } else if (missing.size() == rig.rig.joints.size()) {
    throw Error(
        Status::invalid_argument,
        "no joint of the skeleton (" + named(missing) + ") is one of the animated character's (" +
            named(names_of(source->joints)) + ")",
        "joints are matched by name: pass a character of the same skeleton, or of a known convention");
  } else if (!missing.empty()) {
    warnings.push_back("the animations do not move joints that their character lacks: " + named(missing));
  }
  return result;
}

std::optional<Rig> own_rig(const SourceFile* file) {
  try {
    return file ? file->document.rig(file->primitives) : std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

void warn_of_idle_clips(const SourceFile* file, const std::vector<Joint>& joints,
                        std::vector<std::string>& warnings) {
  const auto former = own_rig(file);
  if (!former || names_of(former->joints) == names_of(joints)) return;  // rigged by this model before
  std::vector<std::string> idle;
  try {
    for (const Clip& clip : file->document.animations().clips)
      if (moves_joint(clip, former->joints)) idle.push_back(clip.name);
  } catch (const Error&) {  // malformed ones stay as they are, too
  }
  if (!idle.empty())
    warnings.push_back(
        "animations of the file move its former skeleton, which the mesh does not follow any more: " +
        named(idle) + "; --animations (animations) plays them on the new one");
}

std::vector<ReplacedJoint> replaced_joints(const SourceFile* file, const std::vector<Joint>& joints) {
  const auto former = own_rig(file);
  if (!former) return {};
  const JointMatch match = match_joints(names_of(joints), names_of(former->joints));
  std::vector<ReplacedJoint> result(joints.size());
  for (size_t j = 0; j < joints.size(); ++j)
    if (match.there[j] >= 0)
      result[j] = {former->joints[match.there[j]].node, former->joints[match.there[j]].bind};
  return result;
}

}  // namespace focal
