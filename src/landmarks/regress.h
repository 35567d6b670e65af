// What a model's regression makes of an analysed mesh, beside the truth.
#pragma once
#include "paper/paper.h"

namespace focal {

// As regress_paper for preset `paper`. Preset `default`: in sqrt(area), the mean of what the samples' leaves hold.
// Throws invalid_argument when the analysis was made with other parameters than the model's.
Regression regress(const LandmarkModel& model, const SurfaceAnalysis& analysis, int32_t landmark,
                   const SurfacePoint& truth, const Execution& execution);

}  // namespace focal
