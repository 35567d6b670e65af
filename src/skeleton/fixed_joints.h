// Joints that are known, as after a correction by hand, and the others that follow them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "skeleton/character_rig.h"

namespace focal {

// Per joint where it must lie; nothing: it follows. Empty: no joint is fixed.
using FixedJoints = std::vector<std::optional<Vector3>>;

// A skeleton in any one coordinate system. What is moved: places, tips, and the turns of the joints, which go with their bones.
struct MovableSkeleton {
  std::vector<int32_t> parent;  // comes before the joint; -1: a root
  std::vector<Vector3>& place;
  std::vector<Vector3>& tip;
  std::vector<Matrix3>& turn;
};

// Puts the fixed joints where they must lie. The others move with them, the less the farther along the bones: displacements d that
// make the sum over the bones of reach^2 |d'|^2 + |d|^2 least. reach: a length in the skeleton's coordinates.
void follow(const FixedJoints& fixed, double reach, const MovableSkeleton& skeleton);

// The same on a finished rig, in the caller's coordinates. Fixed joints have confidence 1 then.
void follow(const FixedJoints& fixed, double reach, CharacterRig& character);

// Of sqrt(area). On left-out bodies of makehuman 0.15 and 0.2 help the other joints most, see docs/accuracy.md.
inline constexpr double fixed_joint_reach = 0.15;

}  // namespace focal
