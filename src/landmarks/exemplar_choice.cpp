#include "landmarks/exemplar_choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "model/sections.h"

namespace focal {
namespace {

constexpr Eigen::Index max_samples = 300;  // more do not change the order

std::vector<int32_t> first_numbers(size_t count) {
  std::vector<int32_t> result(count);
  std::iota(result.begin(), result.end(), 0);
  return result;
}

}  // namespace

std::vector<int32_t> most_alike(const LandmarkModel& model, const Eigen::Ref<const RowMatrixf>& features,
                                size_t most) {
  std::vector<int32_t> order = first_numbers(model.exemplars.size());
  if (model.sample_shape.empty() || order.size() <= most) return order;
  std::vector<double> shared(model.exemplars.size(), 0), rows(model.exemplars.size(), 0);
  for (const int32_t shape : model.sample_shape) ++rows[shape];
  for (Eigen::Index s = 0; s < std::min(features.rows(), max_samples); ++s)
    for (const RegressionTree& tree : model.forests[0].trees) {
      const int32_t leaf = tree.leaf_of(features.row(s).data());
      const int32_t begin = tree.leaf_start[leaf], end = tree.leaf_start[leaf + 1];
      for (int32_t i = begin; i < end; ++i)
        shared[model.sample_shape[tree.leaf_samples[i]]] += 1.0 / (end - begin);
    }
  for (size_t s = 0; s < shared.size(); ++s) shared[s] /= std::max(rows[s], 1.0);
  std::stable_sort(order.begin(), order.end(), [&](int32_t a, int32_t b) { return shared[a] > shared[b]; });
  order.resize(most);
  return order;
}

ConstellationStatistics statistics_of(const LandmarkModel& model, std::span<const int32_t> exemplars) {
  if (exemplars.size() == model.exemplars.size() || model.exemplars[0].constellation.present.empty())
    return model.constellation;
  std::vector<ConstellationSample> samples;
  for (const int32_t shape : exemplars) {
    samples.push_back(model.exemplars[shape].constellation);
    for (RowMatrixf* way : {&samples.back().directions.x, &samples.back().directions.y})
      for (float& value : way->reshaped()) value = kept_direction(value);
  }
  return learn_constellation(samples, static_cast<int32_t>(model.landmark_names.size()));
}

double disagreement(const LandmarkModel& model, const Eigen::Ref<const RowMatrixf>& features) {
  const auto L = model.targets.cols();
  const auto& trees = model.forests[0].trees;
  double total = 0, count = 0;
  Eigen::ArrayXf mean(L), known(L), sum(L), squares(L), says(L);
  for (Eigen::Index s = 0; s < features.rows(); ++s) {
    sum.setZero(), squares.setZero(), says.setZero();
    for (const RegressionTree& tree : trees) {
      const int32_t leaf = tree.leaf_of(features.row(s).data());
      mean.setZero(), known.setZero();
      for (int32_t i = tree.leaf_start[leaf]; i < tree.leaf_start[leaf + 1]; ++i)
        for (Eigen::Index l = 0; l < L; ++l)
          if (const uint16_t target = model.targets(tree.leaf_samples[i], l); target != target_missing)
            mean[l] += target, known[l] += 1;
      mean = (known > 0).select(mean / known.max(1), 0);
      sum += mean, squares += mean.square(), says += (known > 0).cast<float>();
    }
    total += (squares / says.max(1) - (sum / says.max(1)).square()).max(0).sqrt().sum(),
        count += static_cast<double>(L);
  }
  return total / std::max(count, 1.0) / target_steps * model.reach;
}

}  // namespace focal
