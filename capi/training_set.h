// focal_training_set: the builder of what training starts from.
#pragma once
#include <memory>

#include "context.h"
#include "handles.h"
#include "landmarks/training_set.h"

namespace focal {

struct TrainingSetObject {
  using Handle = focal_training_set;
  static constexpr HandleType type = HandleType::training_set;

  std::shared_ptr<const ContextObject> context;
  TrainingSet set;
};

}  // namespace focal
