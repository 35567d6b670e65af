// How sure a placed landmark is: logistic regression on the features for it, learned on training shapes that were left
// out of the forest that samples them.
#pragma once
#include <vector>

#include "landmarks/placement.h"
#include "model/landmark_model.h"

namespace focal {

inline constexpr double near_radius =
    0.04;  // of sqrt(area): "within" of the confidence's meaning; two to four edges

// One samples placement: of a landmark, with its features and its distance from the truth in sqrt(area).
struct CalibrationSample {
  int32_t landmark = 0, mesh = 0;
  PlacementFeatures features;
  double error = 0;
  bool is_marked = true;   // false: the landmark is not on this mesh, so no place is right
  float map_residual = 0;  // of the mesh, see Placement
  bool is_whole = true;  // false: the mesh was corrupted to learn from it, and is no measure of its category
};
// Placements of one mesh stand together.
Calibration calibrate(const std::vector<CalibrationSample>& samples, int32_t landmarks);

// What is believed of a whole mesh, from the features of all its landmarks and the residual of the maps to it.
struct ConfidenceEstimate {
  double category_fit = 1;         // 0..1: does this mesh belong to the category at all?
  std::vector<double> confidence;  // per landmark: that it lies within near_radius of where it should
  std::vector<double>
      absent;  // per landmark, 0..1: that it is not on this mesh; above a half it is called absent
};
ConfidenceEstimate estimate_confidence(const Calibration& calibration,
                                       const std::vector<PlacementFeatures>& features, float map_residual);

double expected_error_of(const Calibration& calibration, double confidence);  // of sqrt(area)

}  // namespace focal
