// T and A poses: a rest pose with the arms stretched out to the sides.
#pragma once
#include <vector>

#include "mesh/rig.h"

namespace focal {

// Poses of the joints: as in `rest`, but each upper arm, lower arm and hand points away from the other side,
// `below` radians below horizontal (y is up), and their descendants move along. The joints' roles
// (bone_roles) identify the arms. Empty: no arms.
std::vector<Matrix4> stretched_arms(const std::vector<Joint>& joints, std::vector<Matrix4> rest,
                                    double below);

}  // namespace focal
