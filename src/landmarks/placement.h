// Preset `default` on one analysed surface: votes of leaf distributions, their peaks, the joint choice among them.
#pragma once
#include <optional>
#include <vector>

#include "analysis/surface_analysis.h"
#include "landmarks/detect.h"
#include "landmarks/exemplar_maps.h"
#include "model/landmark_model.h"

namespace focal {

// What speaks for one placed landmark; the features of its confidence.
struct PlacementFeatures {
  float vote_ratio = 0;  // vote at the place / best vote of the landmark, 0..1
  float residual = 0;    // see ConstellationChoice
  float vote_level = 0;  // vote a sample at the place
  float runner_up = 0;   // best vote of its other peaks / vote at the place
  float border = 1;  // distance from the nearest long border that was closed, of sqrt(area); 1: far or none
  float spread = 0;  // of the marks carried over from the training shapes, of sqrt(area); 0 without maps
  float gap = 0;     // between the votes' place and where they agree, likewise
  bool left_out =
      false;  // it suits the other landmarks nowhere, see ConstellationChoice; no other is placed by it
};

struct Placement {
  std::vector<int32_t> vertex;  // one a landmark, of the analysed surface; -1 when there is no vote for it
  std::vector<SurfacePoint> point;  // the same, between the vertices
  std::vector<int32_t> runner_up;   // its strongest other peak, or -1
  std::vector<std::optional<SurfacePoint>>
      fixed;  // its known place, which nothing moves; empty: none is known
  bool is_fixed(size_t landmark) const { return !fixed.empty() && fixed[landmark].has_value(); }
  std::vector<PlacementFeatures> features;
  std::vector<int32_t> exemplars;       // training shapes that were asked, see landmarks/exemplar_choice.h
  std::vector<ShapeMap> maps;           // from them, with quality `best`
  float map_residual = 0;               // mean of these maps; 0 without
  float bulge_agreement = 0;            // mean of the maps, see bulge_agreement
  Matrix3 frame = Matrix3::Identity();  // the orientation that it supposes, see features_of
  double cost_margin = 0;  // how much more another configuration costs; infinite: none comes near
  RowMatrixf votes;        // vertices of the analysed surface x landmarks
};

// sample_limit: at most so many of the analysis' samples vote. frame: the orientation of the body, where it is known.
Placement place_landmarks(const LandmarkModel& model, const SurfaceAnalysis& analysis, int32_t sample_limit,
                          const DetectParams& params, const Execution& execution, StageSeconds& seconds,
                          const std::optional<Matrix3>& frame = std::nullopt);

// By the votes of preset `paper`, each landmark by itself.
Placement place_landmarks_paper(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                const DetectParams& params, const Execution& execution,
                                StageSeconds& seconds);

}  // namespace focal
