#include "analysis/leaf_votes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/multiversion.h"

namespace focal {
namespace {

// In sqrt(area): less than an edge length of meshes of a few thousand vertices.
constexpr double bin_width = 0.0125;
// Standard deviation of the Gaussian in sqrt(area), as measured in the reference.
constexpr double smoothing = 0.024;
constexpr double mu = 5;  // Xia et al. 2016, Section 5
constexpr int half = 8;   // half the number of the kernel's entries: 4 standard deviations

// Computes rows of a table from rows of a histogram, which starts `half` rows earlier and ends `half` rows
// later.
struct Smoothing {
  const float* histogram;
  const float *decay, *kernel;
  int64_t rows, stride;
};

FOCAL_INLINE void smooth_body(const Smoothing& s, float* table) {
  typedef float Lane __attribute__((vector_size(32), may_alias, aligned(4)));
  for (int64_t r = 0; r < s.rows; ++r)
    for (int64_t lane = 0; lane < s.stride; lane += 8) {
      const float* at = s.histogram + (r + half) * s.stride + lane;  // bin r, whose lower edge is row r
      Lane sum{};
      for (int i = 0; i < half; ++i)
        sum += s.kernel[i] * (*reinterpret_cast<const Lane*>(at - (i + 1) * s.stride) +
                              *reinterpret_cast<const Lane*>(at + i * s.stride));
      *reinterpret_cast<Lane*>(table + r * s.stride + lane) = s.decay[r] * sum;
    }
}
FOCAL_MULTIVERSION(void smooth(const Smoothing& s, float* table), smooth_body(s, table);)

}  // namespace

LeafVoteShape leaf_vote_shape(const LandmarkModel& model) {
  LeafVoteShape shape{static_cast<int32_t>(model.reach / bin_width) + 2,
                      bin_width,
                      model.reach / target_steps / static_cast<float>(bin_width),
                      {},
                      {}};
  for (int i = 0; i < half; ++i)
    shape.kernel.push_back(
        static_cast<float>(std::exp(-0.5 * std::pow((i + 0.5) * bin_width / smoothing, 2)) * bin_width /
                           (smoothing * std::sqrt(2 * std::numbers::pi))));
  for (int32_t r = 0; r <= shape.bins; ++r)
    shape.decay.push_back(static_cast<float>(std::exp(-mu * std::pow(r * bin_width, 2))));
  return shape;
}

LeafVotes::LeafVotes(const LandmarkModel& model, const Eigen::Ref<const RowMatrixf>& descriptors,
                     const Execution& execution)
    : model_(model),
      shape_(leaf_vote_shape(model)),
      stride_(VoteTables::padded(static_cast<int32_t>(model.targets.cols()))),
      target_bin_(static_cast<size_t>(model.targets.rows()) * stride_, static_cast<uint16_t>(shape_.bins)) {
  parallel_for_ranges(execution, model.targets.rows(), 4096, [&](int64_t begin, int64_t end) {
    for (int64_t s = begin; s < end; ++s)
      for (Eigen::Index l = 0; l < model.targets.cols(); ++l)
        if (const uint16_t target = model.targets(s, l); target != target_missing)
          target_bin_[s * stride_ + l] = static_cast<uint16_t>(std::min(
              static_cast<int32_t>(static_cast<float>(target) * shape_.target_to_bin), shape_.bins - 1));
  });
  const auto& trees = model.forests[0].trees;
  leaf_.resize(descriptors.rows(), static_cast<Eigen::Index>(trees.size()));
  parallel_for(execution, leaf_.cols(), [&](int64_t t) {  // one tree stays in cache for all samples
    for (Eigen::Index s = 0; s < leaf_.rows(); ++s) leaf_(s, t) = trees[t].leaf_of(descriptors.row(s).data());
  });
}

// Histogram of the distances in the sample's leaves; all trees have the same weight.
void LeafVotes::add_histogram(int32_t sample, float* histogram) const {
  const auto& trees = model_.forests[0].trees;
  const auto landmarks = static_cast<int32_t>(model_.targets.cols());
  for (size_t t = 0; t < trees.size(); ++t) {
    const int32_t leaf = leaf_(sample, static_cast<Eigen::Index>(t));
    const int32_t begin = trees[t].leaf_start[leaf], end = trees[t].leaf_start[leaf + 1];
    const float weight = 1.0f / static_cast<float>((end - begin) * static_cast<int64_t>(trees.size()));
    for (int32_t i = begin; i < end; ++i) {
      const uint16_t* bin = &target_bin_[static_cast<size_t>(trees[t].leaf_samples[i]) * stride_];
      for (int32_t l = 0; l < landmarks; ++l) histogram[bin[l] * stride_ + l] += weight;
    }
  }
}

VoteTables LeafVotes::tables(int32_t first, int32_t count, const Execution& execution) const {
  const int32_t bin_count = shape_.bins;
  VoteTables tables;
  tables.width = bin_width;
  tables.rows = bin_count + 1;  // at the edges of the bins
  tables.landmarks = static_cast<int32_t>(model_.targets.cols());
  tables.weight.resize(static_cast<size_t>(count) * tables.rows * stride_);
  parallel_for_ranges(execution, count, 8, [&](int64_t begin, int64_t end) {
    std::vector<float> histogram(static_cast<size_t>(bin_count + 1 + 2 * half) * stride_);
    float* bins = histogram.data() + half * stride_;
    const Smoothing how{histogram.data(), shape_.decay.data(), shape_.kernel.data(), tables.rows, stride_};
    for (int64_t s = begin; s < end; ++s) {
      std::fill(histogram.begin(), histogram.end(), 0.0f);
      add_histogram(first + static_cast<int32_t>(s), bins);
      std::fill_n(bins + static_cast<int64_t>(bin_count) * stride_, stride_,
                  // Missing distances do not vote.
                  0.0f);
      smooth(how, tables.of(s));
    }
  });
  return tables;
}

}  // namespace focal
