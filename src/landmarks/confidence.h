// How sure a placed landmark is: logistic regression on the evidence for it, learned on training shapes that were left
// out of the forest that judged them.
#pragma once
#include <array>
#include <vector>

#include "landmarks/model_parts.h"
#include "landmarks/placement.h"

namespace focal {

inline constexpr double near_radius =
    0.04;  // of sqrt(area): "within" of the confidence's meaning; two to four edges

std::array<float, Calibration::feature_count> confidence_features(const Evidence& evidence,
                                                                  float typical_vote);

// One judged placement: of a landmark, with its evidence and its distance from the truth in sqrt(area).
struct JudgedPlacement {
  int32_t landmark = 0, shape = 0;
  Evidence evidence;
  double error = 0;
};
Calibration calibrate(const std::vector<JudgedPlacement>& judged, int32_t landmarks);

double confidence_of(const Calibration& calibration, int32_t landmark, const Evidence& evidence);
double expected_error_of(const Calibration& calibration, double confidence);  // of sqrt(area)
// Does this mesh belong to the category at all? 0..1, from the evidence of all its landmarks.
double category_fit_of(const Calibration& calibration, const std::vector<Evidence>& evidence);

}  // namespace focal
