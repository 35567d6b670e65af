// A model's regressed distances on an analysed mesh, and the true ones.
#pragma once
#include "paper/paper.h"

namespace focal {

// As regress_paper for preset `paper`. Preset `default`: in sqrt(area), the mean over the samples' leaves.
// Throws invalid_argument when the parameters of the analysis differ from the model's.
Regression regress(const LandmarkModel& model, const SurfaceAnalysis& analysis, int32_t landmark,
                   const SurfacePoint& truth, const Execution& execution);

}  // namespace focal
