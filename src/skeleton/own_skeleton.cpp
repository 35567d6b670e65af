#include "skeleton/own_skeleton.h"

#include <algorithm>

#include "base/error.h"
#include "mesh/section.h"
#include "skeleton/bone_heat.h"
#include "skeleton/part_weights.h"

namespace focal {
namespace {

constexpr int32_t analysed_vertices = 6000;  // enough for fingers; no spectrum is needed
// Fraction of the distance to the skin at which a bone without an end stops.
constexpr double short_of_skin = 0.9;
// Chosen on characters of game packs: artists paint harder weights than heat diffusion gives.
constexpr float hardness = 1.5F;  // exponent of the weights
constexpr double heat_strength = 4;

// Joints that move vertices, and their ancestors.
std::vector<char> leads_to_moving(const OwnSkeleton& skeleton) {
  std::vector<char> result = skeleton.moves;
  for (size_t j = result.size(); j-- > 0;)
    if (const int32_t p = skeleton.joints[j].parent; p >= 0 && result[j]) result[p] = 1;
  return result;
}

// Positions in the coordinates of the analysed surface, and the bones between them.
class Bones {
 public:
  Bones(const OwnSkeleton& skeleton, const SurfaceAnalysis& analysis)
      : skeleton_(skeleton), to_caller_(analysis), rays_(analysis.surface()) {
    for (const Joint& joint : skeleton.joints) place_.push_back(inward(place_of(joint)));
    lay();
  }

  const RayCaster& rays() const { return rays_; }
  const std::vector<Bone>& all() const { return bones_; }
  const std::vector<Vector3>& places() const { return place_; }
  const std::vector<Vector3>& tips() const { return tip_; }
  Vector3 to_caller(const Vector3& p) const { return to_caller_(p); }

 private:
  Vector3 inward(const Vector3& p) const { return (p - to_caller_.offset) / to_caller_.scale; }
  std::vector<std::vector<size_t>> children() const;
  void lay();
  Vector3 end_of(size_t joint, const std::vector<size_t>& children) const;

  const OwnSkeleton& skeleton_;
  ToCaller to_caller_;
  RayCaster rays_;
  std::vector<Vector3> place_, tip_;
  std::vector<Bone> bones_;
};

std::vector<std::vector<size_t>> Bones::children() const {
  std::vector<std::vector<size_t>> result(skeleton_.joints.size());
  for (size_t j = 0; j < result.size(); ++j)
    if (const int32_t p = skeleton_.joints[j].parent; p >= 0) result[p].push_back(j);
  return result;
}

// The end of the bone of a joint without moving children: its tip, a child that moves no vertex (an end
// node), or the point towards the skin in the direction of the chain, at most as far as the previous bone is
// long.
Vector3 Bones::end_of(size_t joint, const std::vector<size_t>& children) const {
  if (skeleton_.tip[joint]) return inward(*skeleton_.tip[joint]);
  if (!children.empty()) return place_[children.front()];
  int32_t above = skeleton_.joints[joint].parent;
  while (above >= 0 && (place_[joint] - place_[above]).norm() < 1e-6) above = skeleton_.joints[above].parent;
  if (above < 0) return place_[joint];
  const Vector3 way = place_[joint] - place_[above];
  const auto hit = rays_.first_hit(place_[joint], way);
  return place_[joint] + (hit.triangle >= 0 ? std::min(short_of_skin * hit.distance, 1.0) : 0.0) * way;
}

void Bones::lay() {
  const auto leads = leads_to_moving(skeleton_);
  const auto all = children();
  for (size_t j = 0; j < all.size(); ++j) {
    std::vector<size_t> onward;
    std::copy_if(all[j].begin(), all[j].end(), std::back_inserter(onward),
                 [&](size_t c) { return leads[c]; });
    tip_.push_back(onward.empty() ? end_of(j, all[j]) : place_[onward.front()]);
    if (!skeleton_.moves[j]) continue;
    for (const size_t c : onward) bones_.push_back({static_cast<int32_t>(j), place_[j], place_[c]});
    if (onward.empty()) bones_.push_back({static_cast<int32_t>(j), place_[j], tip_[j]});
  }
}

void check(const OwnSkeleton& skeleton) {
  if (skeleton.joints.empty())
    throw Error(Status::invalid_argument, "the skeleton has no joints", "pass a skeleton, or a rigged mesh");
  if (std::none_of(skeleton.moves.begin(), skeleton.moves.end(), [](char one) { return one; }))
    throw Error(Status::invalid_argument, "no joint of the skeleton moves anything", "let one of them move");
}

SurfaceAnalysis analysis_of(std::shared_ptr<const PreparedMesh> mesh, const Execution& execution) {
  SurfaceAnalysis analysis;
  analysis.proxy = make_proxy(std::move(mesh), analysed_vertices, execution, true);
  execution.check_cancelled();
  analysis.operators = make_operators(analysis.surface(), bridges_of(*analysis.proxy.coarse), true);
  execution.check_cancelled();
  return analysis;
}

void warn_of_outside(const OwnSkeleton& skeleton, const Bones& bones, std::vector<std::string>& warnings) {
  constexpr double inside = 0.5;
  std::string first;
  size_t count = 0;
  for (size_t j = 0; j < skeleton.joints.size(); ++j)
    if (skeleton.moves[j] && winding_number(bones.rays().mesh(), bones.places()[j]) < inside && count++ == 0)
      first = skeleton.joints[j].name;
  if (count > 0)
    warnings.push_back(std::to_string(count) + (count == 1 ? " joint lies" : " joints lie") +
                       " outside the body ('" + first + (count == 1 ? "'): " : "', ...): ") +
                       "what they move is a guess");
}

}  // namespace

OwnSkeleton own_skeleton_of(const Rig& rig) {
  constexpr float main_share = 0.3F;
  OwnSkeleton result{rig.joints, std::vector<char>(rig.joints.size(), 0), {}};
  result.tip.resize(rig.joints.size());
  bool any = false;
  for (const VertexInfluences& vertex : rig.influences)
    if (vertex[0].weight >= main_share) result.moves[vertex[0].joint] = 1, any = true;
  if (!any) std::fill(result.moves.begin(), result.moves.end(), 1);
  return result;
}

CharacterRig weights_for(const OwnSkeleton& skeleton, std::shared_ptr<const PreparedMesh> mesh,
                         int32_t influences, const Execution& execution) {
  check(skeleton);
  execution.begin_stage("surface", 0, 0.4);
  const SurfaceAnalysis analysis = analysis_of(std::move(mesh), execution);
  execution.begin_stage("weights", 0.4, 1);
  const Bones bones(skeleton, analysis);
  const auto count = static_cast<int32_t>(skeleton.joints.size());
  SurfaceWeights weights{
      bone_heat_weights(analysis, bones.rays(), bones.all(), count, execution, heat_strength), hardness};
  CharacterRig result;
  result.rig.joints = skeleton.joints;
  std::vector<SkeletonJoint> named;
  for (const Joint& joint : skeleton.joints) named.push_back({joint.name, joint.parent});
  const PlacedSkeleton placed{named, bones.places(), bones.tips(), {}};
  put_influences_by_parts(weights, placed, analysis, influences, result.rig, execution);
  for (const Vector3& tip : bones.tips()) result.tip.push_back(bones.to_caller(tip));
  result.confidence.assign(skeleton.joints.size(), 1);
  warn_of_outside(skeleton, bones, result.warnings);
  return result;
}

}  // namespace focal
