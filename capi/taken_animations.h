// Animations that a skeleton takes over from another character.
#pragma once
#include <string>
#include <vector>

#include "mesh.h"
#include "skeleton/character_rig.h"
#include "skeleton/retarget.h"

namespace focal {

std::vector<std::string> names_of(const std::vector<Joint>& joints);
// "'a', 'b', 'c' and 3 more"
std::string listed(const std::vector<std::string>& names);
// Whether a clip moves a node that is one of these joints.
bool moves_joint(const Clip& clip, const std::vector<Joint>& joints);

// The character's clips for the joints of the rig. Throws invalid_argument: no file, no skin, no joint in common.
std::vector<JointAnimation> animations_for(const CharacterRig& rig, const PreparedMesh& target,
                                           const MeshObject& character, std::vector<std::string>& warnings);

}  // namespace focal
