// A skeleton and skin weights for a new character, from the rigs of the training shapes and maps from each of them.
#pragma once
#include <string>
#include <vector>

#include "landmarks/detect.h"
#include "mesh/rig.h"

namespace focal {

struct TransferredRig {
  Rig rig;                   // in the coordinates of mesh->source; influences a source vertex
  std::vector<Vector3> tip;  // per joint the far end of its part, in the same coordinates
  // Where each joint goes when the character takes the rest pose of the first training character: turned as that one's joints are,
  // with bones of its own length, its roots where they are.
  std::vector<Matrix4> rest;
  std::vector<double> confidence;  // per joint 0..1: how well the training shapes agree on its place
  std::vector<std::string> warnings;
};

// The joints lie where similarities fitted round each of them to the maps of the rigged training shapes agree; weights are
// the mean of those at the mapped points. Throws invalid_argument when the model has no skeleton, or the detection no
// analysis or fewer than three landmarks that are not absent.
TransferredRig transfer_rig(const Detection& detection, const Execution& execution);

}  // namespace focal
