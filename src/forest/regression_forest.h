// Regression forest (L. Breiman, "Random Forests", 2001; A. Criminisi, J. Shotton, E. Konukoglu, "Decision Forests",
// 2012) from descriptors to distances. A tree is flat arrays; a leaf keeps what its training samples said.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/matrix.h"
#include "base/parallel.h"

namespace focal {

// Node 0 is the root and children come after their parent, left then right, side by side.
struct RegressionTree {
  std::vector<int32_t> feature;  // per node: descriptor component tested, or -1 at a leaf
  std::vector<float> threshold;  // per node: left when descriptor[feature] <= threshold
  std::vector<int32_t> child;    // per node: left child; at a leaf: the leaf's number, 0-based
  // What the leaves hold: either the training samples that fell into each (leaf i has
  // leaf_samples[leaf_start[i] .. leaf_start[i + 1])), or one mean each.
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
  int32_t min_leaf_samples = 5;      // a split leaves at least this many on either side
  int32_t min_split_samples = 10;    // a node of fewer is a leaf
  int32_t components_per_split = 5;  // random descriptor components tried at a node
  uint64_t seed = 0;
};

// Descriptor components cut into at most 256 steps at quantiles, shared by all trees: a split is searched over steps.
struct BinnedDescriptors {
  Eigen::Matrix<uint8_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor> bins;  // samples x components
  std::vector<std::vector<float>> upper;  // per component: largest value of each step but the last, ascending
};
BinnedDescriptors bin_descriptors(const RowMatrixf& descriptors, const Execution& execution);

// Grows trees by information gain, here the reduction of the targets' summed variance.
// targets: samples x outputs. Leaves keep their training samples. One random stream a tree: the same forest for any
// number of threads.
RegressionForest grow_forest(const BinnedDescriptors& descriptors, const RowMatrixf& targets,
                             const ForestParams& params, const Execution& execution);

// Replaces the samples of every leaf by the mean of their targets' column.
void keep_leaf_means(RegressionForest& forest, const RowMatrixf& targets, int32_t column);

// Mean over the trees of the leaf means, for each row of descriptors.
Eigen::VectorXf predict_means(const RegressionForest& forest, const RowMatrixf& descriptors,
                              const Execution& execution);

}  // namespace focal
