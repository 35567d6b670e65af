// Bones that only make a skin fold better: twist bones and helpers, which the joints above them can stand for.
#pragma once
#include <string>
#include <vector>

#include "skeleton/character_rig.h"

namespace focal {

// By the words of its name: twist, roll, helper, corrective, share (UpperArmTwist, CC_Base_L_ElbowShareBone, thigh_twist_01_l).
bool is_helper_bone(const std::string& name);

// Takes them out; the nearest joint above gets what they move and what hangs on them. Roots stay. The numbers of the joints that are
// left, in order.
std::vector<size_t> drop_helper_bones(CharacterRig& character);

}  // namespace focal
