#include "forest/regression_forest.h"

#include <algorithm>
#include <atomic>

#include "forest/tree_builder.h"

namespace focal {

int32_t RegressionTree::leaf_of(const float* descriptor) const {
  int32_t node = 0;
  while (feature[node] >= 0) node = child[node] + (descriptor[feature[node]] <= threshold[node] ? 0 : 1);
  return child[node];
}

BinnedDescriptors bin_descriptors(const RowMatrixf& descriptors, const Execution& execution) {
  constexpr int32_t steps = 256;
  BinnedDescriptors result;
  const auto n = static_cast<int64_t>(descriptors.rows());
  result.bins.resize(descriptors.rows(), descriptors.cols());
  result.upper.resize(descriptors.cols());
  parallel_for(execution, descriptors.cols(), [&](int64_t f) {
    std::vector<float> sorted(n);
    for (int64_t s = 0; s < n; ++s) sorted[s] = descriptors(s, f);
    std::sort(sorted.begin(), sorted.end());
    auto& upper = result.upper[f];
    for (int32_t b = 1; b < steps; ++b) {
      const int64_t i = b * n / steps;
      if (i < 1 || !(sorted[i - 1] < sorted[i])) continue;  // equal values share a bin
      upper.push_back(sorted[i - 1] + (sorted[i] - sorted[i - 1]) / 2);
    }
    for (int64_t s = 0; s < n; ++s)
      result.bins(s, f) = static_cast<uint8_t>(
          std::lower_bound(upper.begin(), upper.end(), descriptors(s, f)) - upper.begin());
  });
  return result;
}

RegressionForest grow_forest(const BinnedDescriptors& descriptors, const RowMatrixf& targets,
                             const ForestParams& params, const Execution& execution) {
  RegressionForest forest;
  forest.trees.resize(params.tree_count);
  std::atomic<int32_t> grown{0};
  parallel_for(execution, params.tree_count, [&](int64_t t) {
    forest.trees[t] = grow_tree(descriptors, targets, params, Random(params.seed, 1000 + t), execution);
    execution.report(static_cast<double>(++grown) / params.tree_count);
  });
  return forest;
}

void keep_leaf_means(RegressionForest& forest, const RowMatrixf& targets, int32_t column) {
  for (RegressionTree& tree : forest.trees) {
    for (size_t leaf = 0; leaf + 1 < tree.leaf_start.size(); ++leaf) {
      double sum = 0;
      for (int32_t i = tree.leaf_start[leaf]; i < tree.leaf_start[leaf + 1]; ++i)
        sum += targets(tree.leaf_samples[i], column);
      tree.leaf_mean.push_back(static_cast<float>(sum / (tree.leaf_start[leaf + 1] - tree.leaf_start[leaf])));
    }
    tree.leaf_start = {}, tree.leaf_samples = {};
  }
}

Eigen::VectorXf predict_means(const RegressionForest& forest, const RowMatrixf& descriptors,
                              const Execution& execution) {
  Eigen::VectorXf result(descriptors.rows());
  parallel_for_ranges(execution, descriptors.rows(), 256, [&](int64_t begin, int64_t end) {
    Vector sum = Vector::Zero(end - begin);
    for (const RegressionTree& tree : forest.trees)  // outer loop: one tree stays in cache for all samples
      for (int64_t s = begin; s < end; ++s)
        sum[s - begin] += tree.leaf_mean[tree.leaf_of(descriptors.row(s).data())];
    result.segment(begin, end - begin) = (sum / static_cast<double>(forest.trees.size())).cast<float>();
  });
  return result;
}

}  // namespace focal
