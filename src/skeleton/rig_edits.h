// What programs want changed in a finished rig: fewer bones, other rest poses, a root on the ground.
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

// Where the joints go: as in `rest`, but each upper arm, lower arm and hand points away from the other side, `below` radians below the
// level (y is up), and what hangs on them goes along. The joints' roles (bone_roles) name the arms. Empty without arms.
std::vector<Matrix4> stretched_arms(const std::vector<Joint>& joints, std::vector<Matrix4> rest,
                                    double below);

// One more joint before all others and above all roots: below the first root, at the height of the mesh's lowest vertex (y is up), turned
// as the mesh is. It moves no vertex.
void add_ground_root(const std::string& name, const TriangleMesh& mesh, CharacterRig& character);

}  // namespace focal
