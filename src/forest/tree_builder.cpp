#include "forest/tree_builder.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "base/multiversion.h"

namespace focal {
namespace {

FOCAL_MULTIVERSION(void add_to(float* sum, const float* values, int32_t count),
                   for (int32_t i = 0; i < count; ++i) sum[i] += values[i];)

// |left|^2 / n_left + |total - left|^2 / n_right: a larger value means less total variance within the two
// sides.
FOCAL_INLINE float gain_body(const float* left, const float* total, float inverse_left, float inverse_right,
                             int32_t count) {
  constexpr int width = 16;  // a fixed number of partial sums gives the same bits at any vector width
  float part[width] = {};
  int32_t i = 0;
  for (; i + width <= count; i += width)
    for (int k = 0; k < width; ++k) {
      const float l = left[i + k], r = total[i + k] - l;
      part[k] += l * l * inverse_left + r * r * inverse_right;
    }
  for (; i < count; ++i) {
    const float l = left[i], r = total[i] - l;
    part[0] += l * l * inverse_left + r * r * inverse_right;
  }
  float sum = 0;
  for (const float p : part) sum += p;
  return sum;
}
FOCAL_MULTIVERSION(float gain_of(const float* left, const float* total, float inverse_left,
                                 float inverse_right, int32_t count),
                   return gain_body(left, total, inverse_left, inverse_right, count);)

struct Split {
  int32_t feature = -1;
  uint8_t bin = 0;  // left: bins <= bin
  float gain = 0;
};

class TreeBuilder {
 public:
  TreeBuilder(const BinnedDescriptors& descriptors, const RowMatrixf& targets, const ForestParams& params,
              Random random, const Execution& execution)
      : descriptors_(descriptors),
        targets_(targets),
        params_(params),
        random_(random),
        execution_(execution),
        outputs_(static_cast<int32_t>(targets.cols())),
        samples_(targets.rows()),
        scratch_(targets.rows()),
        total_(outputs_),
        left_(outputs_) {
    std::iota(samples_.begin(), samples_.end(), 0);
    features_.resize(descriptors.bins.cols());
    std::iota(features_.begin(), features_.end(), 0);
  }

  RegressionTree grow() {
    add_node(0, static_cast<int32_t>(samples_.size()));
    for (size_t node = 0; node < ranges_.size(); ++node) {  // breadth first: children come after their parent
      execution_.check_cancelled();
      const auto [begin, end] = ranges_[node];
      const Split split = best_split(begin, end);
      if (split.feature < 0) {
        make_leaf(node, begin, end);
        continue;
      }
      const int32_t middle = partition(split, begin, end);
      tree_.feature[node] = split.feature;
      tree_.threshold[node] = descriptors_.upper[split.feature][split.bin];
      tree_.child[node] = static_cast<int32_t>(ranges_.size());
      add_node(begin, middle);
      add_node(middle, end);
    }
    tree_.leaf_start.push_back(static_cast<int32_t>(tree_.leaf_samples.size()));
    return std::move(tree_);
  }

 private:
  void add_node(int32_t begin, int32_t end) {
    ranges_.emplace_back(begin, end);
    tree_.feature.push_back(-1);
    tree_.threshold.push_back(0);
    tree_.child.push_back(-1);
  }

  void make_leaf(size_t node, int32_t begin, int32_t end) {
    tree_.child[node] = static_cast<int32_t>(tree_.leaf_start.size());
    tree_.leaf_start.push_back(static_cast<int32_t>(tree_.leaf_samples.size()));
    std::sort(samples_.begin() + begin, samples_.begin() + end);
    tree_.leaf_samples.insert(tree_.leaf_samples.end(), samples_.begin() + begin, samples_.begin() + end);
  }

  Split best_split(int32_t begin, int32_t end) {
    Split best;
    const int32_t count = end - begin;
    if (count < params_.min_split_samples || count < 2 * params_.min_leaf_samples) return best;
    std::fill(total_.begin(), total_.end(), 0.0f);
    for (int32_t i = begin; i < end; ++i) add_to(total_.data(), targets_.row(samples_[i]).data(), outputs_);
    std::fill(left_.begin(), left_.end(), 0.0f);
    // The gain of not splitting, with a margin for rounding: a split must reduce the variance.
    best.gain = gain_of(left_.data(), total_.data(), 0, 1.0f / count, outputs_) * (1 + 1e-6f);
    const auto tries = std::min<size_t>(params_.components_per_split, features_.size());
    for (size_t k = 0; k < tries; ++k) {
      std::swap(features_[k], features_[k + random_.below(static_cast<uint32_t>(features_.size() - k))]);
      try_feature(features_[k], begin, end, best);
    }
    return best;
  }

  // Counting sort of the samples by bin, then one pass with the running sum of the left side.
  void try_feature(int32_t feature, int32_t begin, int32_t end, Split& best) {
    const uint8_t* bins = descriptors_.bins.col(feature).data();
    std::array<int32_t, 257> start{};
    for (int32_t i = begin; i < end; ++i) ++start[bins[samples_[i]] + 1];
    for (int b = 0; b < 256; ++b) start[b + 1] += start[b];
    std::array<int32_t, 256> next;
    std::copy_n(start.begin(), 256, next.begin());
    for (int32_t i = begin; i < end; ++i) scratch_[next[bins[samples_[i]]]++] = samples_[i];
    std::fill(left_.begin(), left_.end(), 0.0f);
    const int32_t count = end - begin;
    for (int32_t b = 0; b < 255 && start[b + 1] < count; ++b) {
      if (start[b] == start[b + 1]) continue;
      for (int32_t i = start[b]; i < start[b + 1]; ++i)
        add_to(left_.data(), targets_.row(scratch_[i]).data(), outputs_);
      const int32_t left = start[b + 1], right = count - left;
      if (left < params_.min_leaf_samples || right < params_.min_leaf_samples) continue;
      const float gain = gain_of(left_.data(), total_.data(), 1.0f / left, 1.0f / right, outputs_);
      if (gain > best.gain) best = {feature, static_cast<uint8_t>(b), gain};
    }
  }

  int32_t partition(const Split& split, int32_t begin, int32_t end) {
    const uint8_t* bins = descriptors_.bins.col(split.feature).data();
    const auto middle = std::stable_partition(samples_.begin() + begin, samples_.begin() + end,
                                              [&](int32_t s) { return bins[s] <= split.bin; });
    return static_cast<int32_t>(middle - samples_.begin());
  }

  const BinnedDescriptors& descriptors_;
  const RowMatrixf& targets_;
  const ForestParams& params_;
  Random random_;
  const Execution& execution_;
  int32_t outputs_;
  std::vector<int32_t> samples_, scratch_, features_;
  std::vector<float> total_, left_;
  std::vector<std::pair<int32_t, int32_t>> ranges_;  // samples of each node
  RegressionTree tree_;
};

}  // namespace

RegressionTree grow_tree(const BinnedDescriptors& descriptors, const RowMatrixf& targets,
                         const ForestParams& params, Random random, const Execution& execution) {
  return TreeBuilder(descriptors, targets, params, random, execution).grow();
}

}  // namespace focal
