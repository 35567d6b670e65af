// A skeleton and skin weights for a new character, from the rigs of the training shapes, maps from each of
// them, and fits of the most similar.
#pragma once
#include "skeleton/character_rig.h"
#include "skeleton/fixed_joints.h"

namespace focal {

// Similarities around each joint, fitted to the maps of the rigged training shapes, give the starts of the
// fits of whole training characters (see body_fit.h). Joints are the consensus of the fits and, as far as
// they agree, of the maps; weights are the mean of those at the fitted points. Throws invalid_argument when
// the model has no skeleton, or the detection no analysis, or neither maps nor three landmarks that are not
// absent. symmetric: see make_symmetric. influences: maximum per vertex, 1 to 8. fixed: in the coordinates of
// mesh->source.
CharacterRig transfer_rig(const Detection& detection, const Execution& execution, bool symmetric = false,
                          int32_t influences = max_influences, const FixedJoints& fixed = {});

}  // namespace focal
