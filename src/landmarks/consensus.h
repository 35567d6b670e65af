// What the maps from the training shapes say of a placement: which of several it should be, and where between the votes'
// place and the carried marks each landmark lies.
#pragma once
#include "landmarks/atlas.h"
#include "landmarks/model_parts.h"
#include "landmarks/placement.h"

namespace focal {

// The choice whose maps from the training shapes are the most alike, weighed against its energy. Two sides or two ends of a
// body that look alike to distances and directions differ in this. vertices: of all candidates.
size_t most_alike(const LandmarkModel& model, const SurfaceAnalysis& analysis, const SpectralTargets& targets,
                  const std::vector<ConstellationChoice>& choices, const std::vector<int32_t>& vertices,
                  const Execution& execution);

// Moves each placed landmark to where its own place and the marks carried over from all training shapes agree, and records
// in its evidence how well they do.
void join_carried_marks(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                        const SpectralTargets& targets, Placement& placement, const Execution& execution);

}  // namespace focal
