// Known joints, for example corrected by hand, and the others, which follow them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "skeleton/character_rig.h"

namespace focal {

// Per joint its required position; nothing: it follows. Empty: no joint is fixed.
using FixedJoints = std::vector<std::optional<Vector3>>;

// A skeleton in any coordinate system. Positions, tips and joint rotations, which follow their bones, are
// changed.
struct MovableSkeleton {
  std::vector<int32_t> parent;  // index of a joint before it; -1: a root
  std::vector<Vector3>& place;
  std::vector<Vector3>& tip;
  std::vector<Matrix3>& turn;
};

// Moves the fixed joints to their positions. The others move along, less the farther away along the bones:
// displacements d that minimise the sum over the bones of reach^2 |d'|^2 + |d|^2. reach: a length in the
// skeleton's coordinates.
void follow(const FixedJoints& fixed, double reach, const MovableSkeleton& skeleton);

// The same on a finished rig, in the caller's coordinates. Fixed joints then have confidence 1.
void follow(const FixedJoints& fixed, double reach, CharacterRig& character);

// In sqrt(area). On left-out bodies of makehuman 0.15 and 0.2 improve the other joints most, see
// docs/accuracy.md.
inline constexpr double fixed_joint_reach = 0.15;

}  // namespace focal
