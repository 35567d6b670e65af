#include "landmarks/leaf_votes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace focal {
namespace {

constexpr double bin_width =
    0.0125;  // of sqrt(area): under an edge length of meshes of a few thousand vertices
constexpr double smoothing =
    0.024;                // standard deviation of the Gaussian, likewise; measured in the reference
constexpr double mu = 5;  // Xia et al. 2016, Section 5

// Entry i: at i + 1/2 bins from the centre of a bin, where the table has its rows.
std::vector<float> gaussian_kernel() {
  std::vector<float> kernel(static_cast<size_t>(std::ceil(4 * smoothing / bin_width)));
  for (size_t i = 0; i < kernel.size(); ++i)
    kernel[i] = static_cast<float>(std::exp(-0.5 * std::pow((i + 0.5) * bin_width / smoothing, 2)) *
                                   bin_width / (smoothing * std::sqrt(2 * std::numbers::pi)));
  return kernel;
}

// bins x landmarks: how often the leaves' samples lie at each distance, all trees weighing the same.
RowMatrixf leaf_histogram(const LandmarkModel& model, const float* descriptor, int32_t bins) {
  RowMatrixf histogram = RowMatrixf::Zero(bins, model.targets.cols());
  const auto& trees = model.forests[0].trees;
  const float to_bin = model.reach / target_steps / static_cast<float>(bin_width);
  for (const RegressionTree& tree : trees) {
    const int32_t leaf = tree.leaf_of(descriptor);
    const int32_t begin = tree.leaf_start[leaf], end = tree.leaf_start[leaf + 1];
    const float weight = 1.0f / static_cast<float>((end - begin) * static_cast<int64_t>(trees.size()));
    for (int32_t i = begin; i < end; ++i) {
      const auto target = model.targets.row(tree.leaf_samples[i]);
      for (Eigen::Index l = 0; l < target.size(); ++l)
        if (target[l] != target_missing)
          histogram(std::min(static_cast<int32_t>(static_cast<float>(target[l]) * to_bin), bins - 1), l) +=
              weight;
    }
  }
  return histogram;
}

}  // namespace

VoteTables leaf_vote_tables(const LandmarkModel& model, const Eigen::Ref<const RowMatrixf>& descriptors,
                            const Execution& execution) {
  const auto bins = static_cast<int32_t>(model.reach / bin_width) + 2;
  VoteTables tables;
  tables.width = bin_width;
  tables.rows = bins + 1;  // at the edges of the bins
  tables.landmarks = static_cast<int32_t>(model.targets.cols());
  tables.weight.assign(static_cast<size_t>(descriptors.rows()) * tables.rows * tables.stride(), 0);
  const std::vector<float> kernel = gaussian_kernel();
  const auto half = static_cast<int32_t>(kernel.size());
  parallel_for(execution, descriptors.rows(), [&](int64_t s) {
    const RowMatrixf histogram = leaf_histogram(model, descriptors.row(s).data(), bins);
    Eigen::Map<RowMatrixf> table(tables.of(s), tables.rows, tables.stride());
    for (int32_t b = 0; b < bins; ++b) {
      if (histogram.row(b).isZero(0)) continue;
      for (int32_t r = std::max(b + 1 - half, 0); r < std::min(b + half, tables.rows); ++r)
        table.row(r).head(tables.landmarks) += kernel[r > b ? r - b - 1 : b - r] * histogram.row(b);
    }
    for (int32_t r = 0; r < tables.rows; ++r)
      table.row(r) *= static_cast<float>(std::exp(-mu * std::pow(r * bin_width, 2)));
  });
  return tables;
}

}  // namespace focal
