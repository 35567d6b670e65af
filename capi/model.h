// focal_model: what training makes and detection uses.
#pragma once
#include <memory>

#include "context.h"
#include "handles.h"
#include "landmarks/landmark_model.h"

namespace focal {

struct ModelObject {
  using Handle = focal_model;
  static constexpr HandleType type = HandleType::model;

  std::shared_ptr<const ContextObject> context;
  std::shared_ptr<const LandmarkModel> model;
  ModelInfo info;
};

}  // namespace focal
