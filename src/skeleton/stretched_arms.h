// T and A poses: a rest pose with its arms stretched out to the sides.
#pragma once
#include <vector>

#include "mesh/rig.h"

namespace focal {

// Where the joints go: as in `rest`, but each upper arm, lower arm and hand points away from the other side, `below` radians below the
// level (y is up), and what hangs on them goes along. The joints' roles (bone_roles) name the arms. Empty: there are none.
std::vector<Matrix4> stretched_arms(const std::vector<Joint>& joints, std::vector<Matrix4> rest,
                                    double below);

}  // namespace focal
