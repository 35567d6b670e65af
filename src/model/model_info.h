// The result of training, as detection uses it, and its file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "model/params.h"

namespace focal {

struct LandmarkModel;  // contents: model/landmark_model.h

struct ModelInfo {
  std::vector<std::string> landmark_names;
  TrainParams params;
  int32_t shape_count = 0;
  int32_t mean_vertex_count = 0;  // of the training surfaces
  int64_t sample_count = 0;
  int64_t tree_node_count = 0;
  std::vector<std::string> joint_names;  // of the skeleton that the rigged training shapes share
};

ModelInfo info_of(const LandmarkModel& model);

}  // namespace focal
