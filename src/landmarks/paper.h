// Preset `paper`: Q. Xia, S. Li, H. Qin, A. Hao, "Automatic Extraction of Generic Focal Features on 3D Shapes via Random
// Forest Regression Analysis of Geodesics-in-Heat", 2016, to the letter.
#pragma once
#include <vector>

#include "landmarks/model_parts.h"
#include "landmarks/placement.h"
#include "landmarks/surface_analysis.h"
#include "landmarks/training_set.h"

namespace focal {

// One forest a landmark. analyses: one a shape of the set, in its order.
void train_paper_forests(LandmarkModel& model, const TrainingSet& set,
                         const std::vector<SurfaceAnalysis>& analyses, const Execution& execution);

// Isoline votes of both signs of the symmetry plane's normal; the one with the higher total vote is kept.
Placement place_landmarks_paper(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                const DetectParams& params, const Execution& execution,
                                StageSeconds& seconds);

// For each sample of the analysis the distance to a landmark by its forest, and the true one to a point of the analysed
// surface, both over the sample's largest distance. Of the two signs of the symmetry plane's normal the one that fits better.
struct Regression {
  Eigen::VectorXf regressed, truth;
};
Regression regress_paper(const LandmarkModel& model, const SurfaceAnalysis& analysis, int32_t landmark,
                         const SurfacePoint& truth, const Execution& execution);

}  // namespace focal
