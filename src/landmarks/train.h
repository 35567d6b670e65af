// Trains a model on marked shapes.
#pragma once
#include "base/parallel.h"
#include "model/model_info.h"
#include "model/training_set.h"

namespace focal {

// Throws too_few_shapes (a landmark on fewer than two shapes), invalid_landmark, cancelled.
LandmarkModel train(const TrainingSet& set, const TrainParams& params, const Execution& execution);

}  // namespace focal
