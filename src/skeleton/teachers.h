// Rigged characters, looked at before they teach: whether their joints are called alike, and whether their skins teach anything.
#pragma once
#include <string>
#include <vector>

#include "skeleton/rigged_shapes.h"

namespace focal {

// Joints are matched by name: as it stands; where more of them match so, without the prefix that the file gives to all of its joints
// ("mixamorig:", "Bip001 "). Then `characters` get the names of the first that has the joint. Returns sentences on what is odd about
// the characters, which they number from 1. Throws invalid_argument when the median character shares fewer than half of its joints
// with the others.
std::vector<std::string> match_teachers(std::vector<RiggedMesh>& characters);

// How much each joint of a character moves, over all vertices, its descendants' share included.
std::vector<double> weight_below(const Rig& rig);

}  // namespace focal
