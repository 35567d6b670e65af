// focal_model: what training makes and detection uses.
#pragma once
#include <memory>

#include "base/lazy.h"
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

  uint64_t file_bytes() const;  // of the model as a file; written once to find out

 private:
  Lazy<uint64_t> file_bytes_;
};

focal_model* publish_model(std::shared_ptr<const ContextObject> context, LandmarkModel model);

}  // namespace focal
