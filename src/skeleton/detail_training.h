// What a model learns of the parts that are analysed once more by themselves; see detail_region.h.
#pragma once
#include "model/landmark_model.h"
#include "skeleton/rigged_shapes.h"

namespace focal {

// One entry a part that the characters have in common and that is worth it. skeleton: of the model that they have taught.
std::vector<DetailModel> learn_details(const std::vector<RiggedMesh>& characters,
                                       const std::vector<SkeletonJoint>& skeleton, uint64_t seed,
                                       const Execution& execution);

}  // namespace focal
