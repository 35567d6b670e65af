#include "skeleton/character.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "skeleton/bone_roles.h"
#include "skeleton/rig_edits.h"
#include "skeleton/rig_transfer.h"
#include "skeleton/taken_animations.h"

namespace focal {
namespace {

// Numbers of the joints that are left, in the model or template.
std::vector<size_t> kept_joints(bool drops_helpers, CharacterRig& rig) {
  if (drops_helpers) return drop_helper_bones(rig);
  std::vector<size_t> all(rig.rig.joints.size());
  std::iota(all.begin(), all.end(), size_t{0});
  return all;
}

std::vector<Matrix4> shown_pose(RestPose pose, const CharacterRig& rig) {
  if (pose == RestPose::of_mesh) return {};
  if (rig.rest.empty())
    throw Error(Status::invalid_argument, "the template has no rest pose",
                R"(give its joints a "rest": the way their bones point)");
  if (pose == RestPose::of_teachers) return rig.rest;
  constexpr double below = std::numbers::pi / 4;
  const auto result = stretched_arms(rig.rig.joints, rig.rest, pose == RestPose::a ? below : 0.0);
  if (result.empty())
    throw Error(Status::invalid_argument, "the skeleton has no two arms, which a T or A pose is made of",
                "ask for the rest pose of the training characters of the model, FOCAL_POSE_OF_TEACHERS");
  return result;
}

void rename_joints(const CharacterParams& params, const std::vector<size_t>& numbers, CharacterRig& rig) {
  auto& joints = rig.rig.joints;
  size_t known = 0;
  const std::vector<std::string> names = names_by_role(joints, params.names, known);
  if (known == 0)
    rig.warnings.push_back("no bone has a role in this convention of names: all of them keep their own");
  for (size_t j = 0; j < joints.size(); ++j)
    joints[j].name = params.own_names.empty() ? names[j] : params.own_names[numbers[j]].value_or(names[j]);
}

void set_verdict(const RigMeasures& measures, Character& character) {
  character.verdict = verdict_of(measures), character.quality = rig_quality(measures);
  const auto joints = static_cast<double>(character.rig.rig.joints.size());
  character.guessed_joints = static_cast<uint32_t>(std::lround(measures.absent_share * joints));
  if (character.verdict == Verdict::good) return;
  std::string text = character.verdict == Verdict::failed ? "the rig failed" : "the rig should be looked at";
  const std::vector<std::string> doubts = doubts_about(measures);
  for (size_t i = 0; i < doubts.size(); ++i) text += (i ? "; " : ": ") + doubts[i];
  character.rig.warnings.push_back(text);
}

void put_root(const char* name, const TriangleMesh& mesh, Character& character) {
  add_ground_root(name, mesh, character.rig);
  auto& pose = character.shown_pose;
  if (!pose.empty()) pose.insert(pose.begin(), character.rig.rig.joints.front().bind);
  for (JointAnimation& one : character.animations) one.joints.insert(one.joints.begin(), JointKeys{});
}

}  // namespace

Character make_character(const Detection& detection, const CharacterParams& params,
                         const Execution& execution) {
  Character result;
  CharacterRig& rig = result.rig;
  const auto& by_hand = params.by_template;
  rig = by_hand ? rig_by_template(*by_hand, detection, execution, params.influences, params.fixed)
                : transfer_rig(detection, execution, params.symmetric, params.influences, params.fixed);
  // Before the joints are renamed: names identify pairs of joints, and those of the model.
  const RigMeasures measures = rig_measures(detection, rig);
  if (!by_hand) calibrate_confidence(rig_quality(measures), params.fixed, rig);
  const std::vector<size_t> numbers = kept_joints(params.drop_helpers, rig);
  result.shown_pose = shown_pose(params.rest_pose, rig);
  if (params.animations)
    result.animations = animations_for(rig, *params.animations, params.scale, rig.warnings);
  rename_joints(params, numbers, rig);
  warn_of_idle_clips(params.file, rig.rig.joints, rig.warnings);
  set_verdict(measures, result);
  if (params.ground_root)
    put_root(params.names == BoneNames::unity ? "Root" : "root", detection.mesh->source, result);
  return result;
}

void put_skeleton(const Character& character, const TriangleMesh& mesh, const SourceFile* own,
                  SourceFile& file) {
  const CharacterRig& from = character.rig;
  GltfRig rig{&from.rig, from.tip, character.shown_pose, character.animations, &mesh};
  rig.replaces = replaced_joints(own, from.rig.joints);
  file.document.add_skin(file.primitives, rig);
}

InfluenceCount count_influences(const Rig& rig) {
  const auto count = [](const VertexInfluences& all) {
    return std::count_if(all.begin(), all.end(), [](const Influence& one) { return one.weight > 0; });
  };
  InfluenceCount result;
  for (size_t v = 0; v < rig.influences.size(); ++v) {
    const auto used =
        static_cast<uint32_t>(count(rig.influences[v]) + (rig.more.empty() ? 0 : count(rig.more[v])));
    result.most = std::max(result.most, used);
    result.unweighted += used == 0;
  }
  return result;
}

}  // namespace focal
