// A skeleton and skin weights for a new character, from the rigs of the training shapes, maps from each of them, and fits of the most alike.
#pragma once
#include "skeleton/character_rig.h"
#include "skeleton/fixed_joints.h"

namespace focal {

// Similarities fitted round each joint to the maps of the rigged training shapes say where the fits of whole training characters start
// (see body_fit.h); joints lie where the fits and, as far as they agree with them, the maps have them, and weights are the mean of those at the
// fitted points. Throws invalid_argument when the model has no skeleton, or the detection no
// analysis, or neither maps nor three landmarks that are not absent. symmetric: see make_symmetric.
// influences: of one vertex at most, 1 to 8. fixed: in the coordinates of mesh->source.
CharacterRig transfer_rig(const Detection& detection, const Execution& execution, bool symmetric = false,
                          int32_t influences = max_influences, const FixedJoints& fixed = {});

}  // namespace focal
