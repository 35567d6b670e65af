// Preset `paper`: Q. Xia, S. Li, H. Qin, A. Hao, "Automatic Extraction of Generic Focal Features on 3D Shapes
// via Random Forest Regression Analysis of Geodesics-in-Heat", 2016, exactly as published.
#pragma once
#include <vector>

#include "analysis/surface_analysis.h"
#include "model/landmark_model.h"
#include "model/training_set.h"

namespace focal {

// One forest per landmark. analyses: one per shape of the set, in its order.
void train_paper_forests(LandmarkModel& model, const TrainingSet& set,
                         const std::vector<SurfaceAnalysis>& analyses, const Execution& execution);

// Averaged isoline votes, for the sign of the symmetry plane's normal with the higher total vote.
struct PaperVotes {
  RowMatrixf votes;             // vertices x landmarks
  std::vector<int32_t> vertex;  // per landmark: the vertex with the highest vote
  std::vector<float> level;     // its vote per sample
};
PaperVotes paper_votes(const LandmarkModel& model, const SurfaceAnalysis& analysis, uint64_t seed,
                       const Execution& execution, StageSeconds& seconds);

// For each sample of the analysis the distance to a landmark predicted by its forest, and the true distance
// to a point of the analysed surface, both divided by the sample's largest distance. Uses the sign of the
// symmetry plane's normal that fits better.
struct Regression {
  Eigen::VectorXf regressed, truth;
};
Regression regress_paper(const LandmarkModel& model, const SurfaceAnalysis& analysis, int32_t landmark,
                         const SurfacePoint& truth, const Execution& execution);

}  // namespace focal
