// Regression forest (L. Breiman, "Random Forests", 2001; A. Criminisi, J. Shotton, E. Konukoglu, "Decision
// Forests", 2012) from descriptors to distances. A tree is stored in flat arrays; a leaf stores its training
// samples or their mean.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/matrix.h"
#include "base/parallel.h"

namespace focal {

// Node 0 is the root. Children come after their parent; left and right are adjacent.
struct RegressionTree {
  std::vector<int32_t> feature;  // per node: descriptor component tested, or -1 at a leaf
  std::vector<float> threshold;  // per node: left when descriptor[feature] <= threshold
  std::vector<int32_t> child;    // per node: left child; at a leaf: the leaf's number, 0-based
  // Contents of the leaves: either the training samples in each (leaf i has leaf_samples[leaf_start[i] ..
  // leaf_start[i + 1])), or one mean each.
  std::vector<int32_t> leaf_start;
  std::vector<int32_t> leaf_samples;
  std::vector<float> leaf_mean;

  int32_t leaf_of(const float* descriptor) const;
};

struct RegressionForest {
  std::vector<RegressionTree> trees;
};

struct ForestParams {
  int32_t tree_count = 30;
  int32_t min_leaf_samples = 5;      // minimum on either side of a split
  int32_t min_split_samples = 10;    // smaller nodes are leaves
  int32_t components_per_split = 5;  // random descriptor components tried per node
  uint64_t seed = 0;
};

// Descriptor components quantised to at most 256 bins at quantiles, shared by all trees: splits are searched
// over bins.
struct BinnedDescriptors {
  Eigen::Matrix<uint8_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor> bins;  // samples x components
  std::vector<std::vector<float>> upper;  // per component: largest value of each bin but the last, ascending
};
BinnedDescriptors bin_descriptors(const RowMatrixf& descriptors, const Execution& execution);

// Grows trees by information gain, here the reduction of the targets' summed variance. targets: samples x
// outputs. Leaves store their training samples. One random stream per tree: the same forest for any number of
// threads.
RegressionForest grow_forest(const BinnedDescriptors& descriptors, const RowMatrixf& targets,
                             const ForestParams& params, const Execution& execution);

// Replaces the samples of every leaf by the mean of their targets in one column.
void keep_leaf_means(RegressionForest& forest, const RowMatrixf& targets, int32_t column);

// Mean over the trees of the leaf means, for each row of descriptors.
Eigen::VectorXf predict_means(const RegressionForest& forest, const RowMatrixf& descriptors,
                              const Execution& execution);

}  // namespace focal
