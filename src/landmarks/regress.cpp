#include "landmarks/regress.h"

#include <cmath>

#include "landmarks/detect.h"
#include "landmarks/features.h"

namespace focal {
namespace {

float mean_of_leaves(const LandmarkModel& model, const float* descriptor, int32_t landmark) {
  double sum = 0, count = 0;
  for (const RegressionTree& tree : model.forests[0].trees) {
    const int32_t leaf = tree.leaf_of(descriptor);
    for (int32_t i = tree.leaf_start[leaf]; i < tree.leaf_start[leaf + 1]; ++i) {
      const uint16_t target = model.targets(tree.leaf_samples[i], landmark);
      if (target != target_missing) sum += target, ++count;
    }
  }
  return count > 0 ? static_cast<float>(sum / count / target_steps * model.reach) : NAN;
}

}  // namespace

Regression regress(const LandmarkModel& model, const SurfaceAnalysis& analysis, int32_t landmark,
                   const SurfacePoint& truth, const Execution& execution) {
  check_suits(analysis, model);
  const SurfacePoint place = to_coarse(analysis.proxy, {&truth, 1})[0];
  if (model.params.preset == Preset::paper) return regress_paper(model, analysis, landmark, place, execution);
  const auto count = static_cast<Eigen::Index>(analysis.samples.size());
  const RowMatrixf distances = analysis.metric->distances(std::span(&place, 1), execution);
  const RowMatrixf features =
      features_of(analysis, static_cast<int32_t>(count), model.params, Matrix3::Identity());
  Regression result{Eigen::VectorXf(count), Eigen::VectorXf(count)};
  for (Eigen::Index s = 0; s < count; ++s) {
    result.regressed[s] = mean_of_leaves(model, &features(s, 0), landmark);
    result.truth[s] = distances(0, analysis.samples[s]);
  }
  return result;
}

}  // namespace focal
