// What the joints of a humanoid are for, however they are spelled: from the words of their names and from where they hang.
#pragma once
#include <string>
#include <vector>

#include "mesh/rig.h"
#include "skeleton/bone_names.h"

namespace focal {

// Per joint the VRM 1.0 name of its role (hips, leftUpperArm, ...); empty: it has none, or another joint has it. Names of the conventions
// of bone_names.h are taken at their word, others are read as words; spines and fingers go by their order. All empty where there are no
// hips, head or limbs: then it is no humanoid.
std::vector<std::string> bone_roles(const std::vector<Joint>& joints);

// Every joint's name in a convention, by its role, or else by its own name where that is one of a convention; the others keep theirs.
// known: how many have one.
std::vector<std::string> names_by_role(const std::vector<Joint>& joints, BoneNames convention, size_t& known);

}  // namespace focal
