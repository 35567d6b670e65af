// A ball round a found landmark against the ball of a training shape, carried over by the dense correspondence.
#pragma once
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "landmarks/detect.h"
#include "shapes.h"

namespace focal_robustness {

struct RegionResult {
  double radius = 0;       // of sqrt(area)
  double found_iou = 0;    // mean, by area, of the balls round the found landmarks
  double true_iou = 0;     // likewise round the true ones: what a perfect detection would reach
  double share_under = 0;  // of the regions with an IoU of the found ball below 0.7
  int64_t regions = 0;
};

// found: of the clean shapes. Empty without dense correspondence.
std::vector<RegionResult> measure_regions(const Shapes& shapes,
                                          const std::vector<std::vector<focal::DetectedLandmark>>& found);
void print_regions(const std::vector<RegionResult>& results);
nlohmann::json json_of(const std::vector<RegionResult>& results);

}  // namespace focal_robustness
