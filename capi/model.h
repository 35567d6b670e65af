// focal_model: what training makes and detection uses.
#pragma once
#include <memory>
#include <optional>

#include "base/lazy.h"
#include "context.h"
#include "handles.h"
#include "model/model_info.h"
#include "skeleton/skeleton_template.h"

namespace focal {

struct ModelObject {
  using Handle = focal_model;
  static constexpr HandleType type = HandleType::model;

  std::shared_ptr<const ContextObject> context;
  std::shared_ptr<const LandmarkModel> model;
  ModelInfo info;                               // its joints: those of `by_template`, where there is one
  std::optional<SkeletonTemplate> by_template;  // the skeleton over marked landmarks that it carries

  bool learned_skeleton() const { return !info.joint_names.empty() && !by_template; }

  uint64_t file_bytes() const;  // of the model as a file; written once to find out

 private:
  Lazy<uint64_t> file_bytes_;
};

focal_model* publish_model(std::shared_ptr<const ContextObject> context, LandmarkModel model);

}  // namespace focal
