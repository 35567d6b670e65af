// Bones that only improve the deformation of a skin: twist bones and helpers, whose weights the joints above
// them can take over.
#pragma once
#include <string>
#include <vector>

#include "skeleton/character_rig.h"

namespace focal {

// Recognised by the words of its name: twist, roll, helper, corrective, share (UpperArmTwist,
// CC_Base_L_ElbowShareBone, thigh_twist_01_l).
bool is_helper_bone(const std::string& name);

// Removes them; their weights and children go to the nearest remaining joint above. Roots are kept. Returns
// the numbers of the remaining joints, in order.
std::vector<size_t> drop_helper_bones(CharacterRig& character);

}  // namespace focal
