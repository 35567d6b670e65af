// Checks rigged characters before training: whether their joints have matching names, and whether their skins
// are usable.
#pragma once
#include <string>
#include <vector>

#include "skeleton/rigged_shapes.h"

namespace focal {

// Joints are matched by name: unchanged or, if that gives more matches, without the prefix that a file has on
// all of its joints ("mixamorig:", "Bip001 "). Then `characters` get the names of the first that has the
// joint. Returns warnings, which number the characters from 1. Throws invalid_argument when the median
// character shares fewer than half of its joints with the others.
std::vector<std::string> match_teachers(std::vector<RiggedMesh>& characters);

// How much each joint of a character moves, summed over all vertices, descendants included.
std::vector<double> weight_below(const Rig& rig);

}  // namespace focal
