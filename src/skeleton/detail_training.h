// Trains the models of parts that get a second analysis of their own; see detail_region.h.
#pragma once
#include "model/landmark_model.h"
#include "skeleton/rigged_shapes.h"

namespace focal {

// One entry per part that the characters have in common and that qualifies. skeleton: of the model trained on
// them.
std::vector<DetailModel> learn_details(const std::vector<RiggedMesh>& characters,
                                       const std::vector<SkeletonJoint>& skeleton, uint64_t seed,
                                       const Execution& execution);

}  // namespace focal
