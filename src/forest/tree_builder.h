// Grows one tree.
#pragma once
#include "base/random.h"
#include "forest/regression_forest.h"

namespace focal {

RegressionTree grow_tree(const BinnedDescriptors& descriptors, const RowMatrixf& targets,
                         const ForestParams& params, Random random, const Execution& execution);

}  // namespace focal
