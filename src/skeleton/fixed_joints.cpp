#include "skeleton/fixed_joints.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace focal {
namespace {

constexpr double shortest_bone = 1e-9;  // shorter bones have no direction

// For each joint the length of the bone to its parent, with a lower limit relative to the reach.
std::vector<double> bone_lengths(const MovableSkeleton& skeleton, double reach) {
  std::vector<double> length(skeleton.place.size(), 0);
  for (size_t j = 0; j < length.size(); ++j)
    if (const int32_t p = skeleton.parent[j]; p >= 0)
      length[j] = std::max((skeleton.place[j] - skeleton.place[p]).norm(), 1e-4 * reach);
  return length;
}

// The linear system is a tree: eliminated from the leaves to the roots, then solved back. Quadratic elements
// along the bones, with their lengths lumped at the joints.
std::vector<Vector3> displacements(const FixedJoints& fixed, double reach, const MovableSkeleton& skeleton) {
  const size_t count = skeleton.place.size();
  const std::vector<double> length = bone_lengths(skeleton, reach);
  std::vector<double> pull(count, 0), diagonal(count, 1e-9 * reach);
  for (size_t j = 0; j < count; ++j) {
    const int32_t p = skeleton.parent[j];
    if (p < 0) continue;
    pull[j] = reach * reach / length[j];
    diagonal[j] += pull[j] + length[j] / 2, diagonal[p] += pull[j] + length[j] / 2;
  }
  std::vector<Vector3> right(count, Vector3::Zero()), moved(count, Vector3::Zero());
  for (size_t j = count; j-- > 0;) {
    const int32_t p = skeleton.parent[j];
    if (fixed[j]) moved[j] = *fixed[j] - skeleton.place[j];
    if (p < 0) continue;
    right[p] += pull[j] * (fixed[j] ? moved[j] : Vector3(right[j] / diagonal[j]));
    if (!fixed[j]) diagonal[p] -= pull[j] * pull[j] / diagonal[j];
  }
  for (size_t j = 0; j < count; ++j) {
    if (fixed[j]) continue;
    const int32_t p = skeleton.parent[j];
    moved[j] = (right[j] + (p >= 0 ? Vector3(pull[j] * moved[p]) : Vector3::Zero())) / diagonal[j];
  }
  return moved;
}

}  // namespace

void follow(const FixedJoints& fixed, double reach, const MovableSkeleton& skeleton) {
  if (fixed.empty()) return;
  const std::vector<Vector3> moved = displacements(fixed, reach, skeleton);
  const std::vector<Vector3> before = bone_directions(skeleton.parent, skeleton.place, skeleton.tip);
  for (size_t j = 0; j < moved.size(); ++j) skeleton.place[j] += moved[j], skeleton.tip[j] += moved[j];
  const std::vector<Vector3> after = bone_directions(skeleton.parent, skeleton.place, skeleton.tip);
  for (size_t j = 0; j < moved.size(); ++j) {
    if (fixed[j]) skeleton.place[j] = *fixed[j];
    if (before[j].norm() > shortest_bone && after[j].norm() > shortest_bone)
      skeleton.turn[j] =
          Eigen::Quaterniond::FromTwoVectors(before[j], after[j]).toRotationMatrix() * skeleton.turn[j];
  }
}

void follow(const FixedJoints& fixed, double reach, CharacterRig& character) {
  if (fixed.empty()) return;
  auto& joints = character.rig.joints;
  std::vector<int32_t> parent;
  std::vector<Vector3> place;
  std::vector<Matrix3> turn;
  for (const Joint& joint : joints) {
    parent.push_back(joint.parent), place.push_back(joint.bind.topRightCorner<3, 1>());
    turn.push_back(joint.bind.topLeftCorner<3, 3>());
  }
  follow(fixed, reach, {parent, place, character.tip, turn});
  for (size_t j = 0; j < joints.size(); ++j) {
    joints[j].bind.topRightCorner<3, 1>() = place[j], joints[j].bind.topLeftCorner<3, 3>() = turn[j];
    if (fixed[j]) character.confidence[j] = 1;
  }
}

}  // namespace focal
