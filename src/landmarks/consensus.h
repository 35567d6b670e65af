// What the maps from the training shapes say of a placement: where between the votes' place and the carried marks each
// landmark lies, and how well they agree.
#pragma once
#include "landmarks/atlas.h"
#include "landmarks/model_parts.h"
#include "landmarks/placement.h"

namespace focal {

// Moves each placed landmark to where its own place and the marks carried over from all training shapes agree, and records
// in its evidence how well they do.
void join_carried_marks(const LandmarkModel& model, const SurfaceAnalysis& analysis, Placement& placement,
                        const Execution& execution);

}  // namespace focal
