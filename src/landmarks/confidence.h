// Confidence of a placed landmark: logistic regression on its features, learned on training shapes that the
// forest was not trained on.
#pragma once
#include <vector>

#include "landmarks/placement.h"
#include "model/landmark_model.h"

namespace focal {

// In sqrt(area): the radius that the confidence refers to; two to four edges.
inline constexpr double near_radius = 0.04;

// One training sample: a placed landmark with its features and its distance from the true place in
// sqrt(area).
struct CalibrationSample {
  int32_t landmark = 0, mesh = 0;
  PlacementFeatures features;
  double error = 0;
  bool is_marked = true;   // false: the landmark is absent on this mesh, so no place is correct
  float map_residual = 0;  // of the mesh, see Placement
  bool is_whole = true;    // false: the mesh was corrupted for training and does not represent its category
};
// Placements of one mesh must be consecutive.
Calibration calibrate(const std::vector<CalibrationSample>& samples, int32_t landmarks);

// Estimates for a whole mesh, from the features of all its landmarks and the residual of the maps to it.
struct ConfidenceEstimate {
  double category_fit = 1;         // 0..1: whether the mesh belongs to the category
  std::vector<double> confidence;  // per landmark: probability of being within near_radius of the true place
  // Per landmark, 0..1: probability that it is absent from this mesh; above a half it is reported as absent.
  std::vector<double> absent;
};
ConfidenceEstimate estimate_confidence(const Calibration& calibration,
                                       const std::vector<PlacementFeatures>& features, float map_residual);

double expected_error_of(const Calibration& calibration, double confidence);  // in sqrt(area)

}  // namespace focal
