// Roles of the joints of a humanoid in any spelling: from the words of their names and from the hierarchy.
#pragma once
#include <string>
#include <vector>

#include "mesh/rig.h"
#include "skeleton/bone_names.h"

namespace focal {

// For each joint the VRM 1.0 name of its role (hips, leftUpperArm, ...); empty: it has none, or another joint
// has it. Names of the conventions of bone_names.h are matched exactly, others by their words; spines and
// fingers by their order. All empty without hips, head or limbs: not a humanoid.
std::vector<std::string> bone_roles(const std::vector<Joint>& joints);

// The name of every joint in a convention, by its role, or else by its own name where that belongs to a
// convention; the others keep theirs. known: number of joints that have one.
std::vector<std::string> names_by_role(const std::vector<Joint>& joints, BoneNames convention, size_t& known);

}  // namespace focal
