// The last step of preset `default`: moves each landmark near its current place to the vertex that agrees
// best with its votes and with its distances to the other landmarks.
#pragma once
#include "analysis/surface_analysis.h"
#include "landmarks/placement.h"
#include "model/landmark_model.h"

namespace focal {

void refine_placement(const ConstellationStatistics& statistics, const SurfaceAnalysis& analysis,
                      Placement& placement, const Execution& execution);

}  // namespace focal
