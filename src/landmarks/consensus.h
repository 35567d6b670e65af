// What the maps from the training shapes say of a placement: where between the votes' place and the carried marks each
// landmark lies, and how well they agree.
#pragma once
#include "landmarks/atlas.h"
#include "landmarks/model_parts.h"
#include "landmarks/placement.h"

namespace focal {

// Moves each placed landmark to where its own place and the marks carried over from all training shapes agree, and records
// in its evidence how well they do. Quality `interactive` asks a few shapes in fewer rounds and leaves the evidence as it is.
void join_carried_marks(const LandmarkModel& model, const SurfaceAnalysis& analysis, Quality quality,
                        Placement& placement, const Execution& execution);

// How far the maps of a few training shapes, started from the placement, are from fitting; less is better.
double quick_map_residual(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                          const Placement& placement, const Execution& execution);

}  // namespace focal
