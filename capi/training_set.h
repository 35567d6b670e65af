// focal_training_set: the builder of what training starts from.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "context.h"
#include "handles.h"
#include "model/training_set.h"
#include "skeleton/rigged_shapes.h"

namespace focal {

struct TrainingSetObject {
  using Handle = focal_training_set;
  static constexpr HandleType type = HandleType::training_set;

  std::shared_ptr<const ContextObject> context;
  TrainingSet set;
  std::vector<RiggedMesh> characters;  // of a set without landmark names: these follow from their skeletons
  std::vector<std::string> warnings;   // of the last check
};

}  // namespace focal
