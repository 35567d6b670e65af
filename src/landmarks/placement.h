// Preset `default` on one analysed surface: votes of leaf distributions, their peaks, the joint choice among them.
#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "analysis/surface_analysis.h"
#include "landmarks/detect.h"
#include "landmarks/exemplar_maps.h"
#include "model/landmark_model.h"

namespace focal {

// Evidence for one placed landmark: the features of its confidence.
struct PlacementFeatures {
  float vote_ratio = 0;  // vote at the place / best vote of the landmark, 0..1
  float residual = 0;    // see ConstellationChoice
  float vote_level = 0;  // vote per sample at the place
  float runner_up = 0;   // best vote of its other peaks / vote at the place
  float border = 1;  // distance from the nearest long border that was closed, in sqrt(area); 1: far or none
  float spread = 0;  // of the landmarks transferred from the training shapes, in sqrt(area); 0 without maps
  float gap = 0;     // between the votes' place and the consensus, likewise
  // It fits the other landmarks nowhere, see ConstellationChoice; no other landmark depends on it.
  bool left_out = false;
};

struct Placement {
  std::vector<int32_t> vertex;      // one per landmark, on the analysed surface; -1 without votes
  std::vector<SurfacePoint> point;  // the same, between the vertices
  std::vector<int32_t> runner_up;   // its strongest other peak, or -1
  // The known place, which is never moved; empty: unknown.
  std::vector<std::optional<SurfacePoint>> fixed;
  bool is_fixed(size_t landmark) const { return !fixed.empty() && fixed[landmark].has_value(); }
  std::vector<PlacementFeatures> features;
  std::vector<int32_t> exemplars;       // training shapes used, see landmarks/exemplar_choice.h
  std::vector<ShapeMap> maps;           // from them, with quality `best`
  float map_residual = 0;               // mean over these maps; 0 without maps
  float bulge_agreement = 0;            // mean over the maps, see bulge_agreement
  Matrix3 frame = Matrix3::Identity();  // the assumed orientation, see features_of
  double heading_advantage = std::numeric_limits<double>::infinity();  // of this orientation, see Heading
  double cost_margin = 0;  // extra cost of the second-best configuration; infinite: none is close
  RowMatrixf votes;        // vertices of the analysed surface x landmarks
};

// sample_limit: maximum number of the analysis' samples that vote. frame: the orientation of the body, if
// known.
Placement place_landmarks(const LandmarkModel& model, const SurfaceAnalysis& analysis, int32_t sample_limit,
                          const DetectParams& params, const Execution& execution, StageSeconds& seconds,
                          const std::optional<Matrix3>& frame = std::nullopt);

// With the votes of preset `paper`, each landmark on its own.
Placement place_landmarks_paper(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                const DetectParams& params, const Execution& execution,
                                StageSeconds& seconds);

}  // namespace focal
