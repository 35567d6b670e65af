#include "paper/paper.h"

#include <algorithm>
#include <cmath>

#include "analysis/isoline_votes.h"
#include "base/stopwatch.h"
#include "paper/symmetry_plane.h"

namespace focal {
namespace {

constexpr int lanes = Distance::lanes;

// +1 on the side to which the symmetry plane's normal points, -1 on the other (Section 4.1).
Vector signed_sides(const SymmetryPlane& plane, const MatrixX3& positions) {
  return (positions * plane.normal).array() - plane.offset;
}

// Section 4.1: on the side opposite to the normal, the components are in reverse order.
RowMatrixf with_sides(const RowMatrixf& descriptors, std::span<const int32_t> samples, const Vector& side,
                      double sign) {
  RowMatrixf result = descriptors;
  for (size_t s = 0; s < samples.size(); ++s)
    if (side[samples[s]] * sign < 0) result.row(s) = descriptors.row(s).reverse().eval();
  return result;
}

// samples x landmarks: distance from the sample to the landmark divided by the sample's largest distance; NaN
// where the landmark is absent.
RowMatrixf normalised_targets(const MarkedShape& shape, const SurfaceAnalysis& analysis,
                              const Execution& execution) {
  RowMatrixf targets = RowMatrixf::Constant(analysis.samples.size(), shape.marks.size(), NAN);
  const int32_t n = analysis.metric->vertex_count();
  analysis.metric->for_each_block(
      analysis.samples, execution, [&](int64_t first, int32_t count, const float* distances) {
        float largest[lanes];
        largest_distances(distances, n, largest);
        for (size_t l = 0; l < shape.marks.size(); ++l) {
          if (!shape.marks[l]) continue;
          for (int32_t j = 0; j < count; ++j) {
            double d = 0;
            for (int i = 0; i < 3; ++i)
              d +=
                  shape.marks[l]->barycentric[i] *
                  distances[static_cast<int64_t>(shape.mesh->surface.triangles(shape.marks[l]->triangle, i)) *
                                lanes +
                            j];
            targets(first + j, l) = static_cast<float>(d / largest[j]);
          }
        }
      });
  return targets;
}

// The paper does not define the sign of the normal. Ours: the sign for which the landmarks' sides agree with
// the first shape's.
double consistent_sign(const MarkedShape& shape, const MarkedShape& first, const Vector& side,
                       const Vector& first_side) {
  const auto at_mark = [](const MarkedShape& s, size_t l, const Vector& value) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      sum += s.marks[l]->barycentric[i] * value[s.mesh->surface.triangles(s.marks[l]->triangle, i)];
    return sum;
  };
  double agreement = 0;
  for (size_t l = 0; l < shape.marks.size(); ++l)
    if (shape.marks[l] && first.marks[l])
      agreement += at_mark(shape, l, side) * at_mark(first, l, first_side);
  return agreement < 0 ? -1 : 1;
}

// Trains the forest of one landmark on the samples of the shapes that have it.
RegressionForest landmark_forest(const BinnedDescriptors& descriptors, const RowMatrixf& targets,
                                 int32_t landmark, const ForestParams& params, const Execution& execution) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index s = 0; s < targets.rows(); ++s)
    if (!std::isnan(targets(s, landmark))) rows.push_back(s);
  const RowMatrixf own_targets = targets(rows, std::vector<int32_t>{landmark});
  const bool everywhere = static_cast<Eigen::Index>(rows.size()) == targets.rows();
  RegressionForest forest = everywhere ? grow_forest(descriptors, own_targets, params, execution)
                                       : grow_forest({descriptors.bins(rows, Eigen::all), descriptors.upper},
                                                     own_targets, params, execution);
  keep_leaf_means(forest, own_targets, 0);
  return forest;
}

}  // namespace

void train_paper_forests(LandmarkModel& model, const TrainingSet& set,
                         const std::vector<SurfaceAnalysis>& analyses, const Execution& execution) {
  Eigen::Index rows = 0;
  for (const auto& analysis : analyses) rows += analysis.descriptors.rows();
  RowMatrixf descriptors(rows, analyses[0].descriptors.cols()), targets(rows, set.landmark_names.size());
  Vector first_side;
  Eigen::Index row = 0;
  execution.begin_stage("distances", 0.4, 0.7);
  for (size_t s = 0; s < analyses.size(); ++s) {
    const MarkedShape& shape = set.shapes[s];
    const Vector side = signed_sides(symmetry_plane(shape.mesh->surface, model.params.seed, execution),
                                     shape.mesh->surface.positions);
    if (s == 0) first_side = side;
    const double sign = consistent_sign(shape, set.shapes[0], side, first_side);
    const auto count = analyses[s].descriptors.rows();
    descriptors.middleRows(row, count) = with_sides(analyses[s].descriptors, analyses[s].samples, side, sign);
    targets.middleRows(row, count) = normalised_targets(shape, analyses[s], execution);
    row += count;
    execution.report(static_cast<double>(s + 1) / static_cast<double>(analyses.size()));
  }
  model.reach = 1;
  ForestParams forest{.tree_count = model.params.tree_count,
                      .min_leaf_samples = 1,
                      .min_split_samples = 2 * model.params.min_leaf_samples,
                      .components_per_split = model.params.components_per_split,
                      .seed = model.params.seed};
  const auto L = static_cast<int32_t>(set.landmark_names.size());
  const BinnedDescriptors binned = bin_descriptors(descriptors, execution);
  for (int32_t l = 0; l < L; ++l) {
    execution.begin_stage("forest", 0.7 + 0.3 * l / L, 0.7 + 0.3 * (l + 1) / L);
    model.forests.push_back(landmark_forest(binned, targets, l, forest, execution));
  }
}

PaperVotes paper_votes(const LandmarkModel& model, const SurfaceAnalysis& analysis, uint64_t seed,
                       const Execution& execution, StageSeconds& seconds) {
  Stopwatch watch;
  const auto L = static_cast<Eigen::Index>(model.landmark_names.size());
  const Vector side =
      signed_sides(symmetry_plane(analysis.surface(), seed, execution), analysis.surface().positions);
  seconds.descriptors += watch.lap();
  RowMatrixf radii(analysis.descriptors.rows(), 2 * L);  // of both signs
  for (int s = 0; s < 2; ++s) {
    const RowMatrixf descriptors = with_sides(analysis.descriptors, analysis.samples, side, s ? -1 : 1);
    for (Eigen::Index l = 0; l < L; ++l)
      radii.col(s * L + l) = predict_means(model.forests[l], descriptors, execution);
  }
  seconds.forest += watch.lap();
  const RowMatrixf both = analysis.engine->isoline_votes(analysis, radii, execution);
  seconds.vote += watch.lap();
  // "Higher total vote": the sum over the landmarks of the winning mean vote.
  const auto total = [&](int s) { return both.middleCols(s * L, L).colwise().maxCoeff().sum(); };
  PaperVotes result{both.middleCols(total(1) > total(0) ? L : 0, L), {}, {}};
  for (Eigen::Index l = 0; l < L; ++l) {
    Eigen::Index best = 0;
    const float vote = result.votes.col(l).maxCoeff(&best);
    result.vertex.push_back(static_cast<int32_t>(best));
    result.level.push_back(vote / static_cast<float>(analysis.samples.size()));
  }
  return result;
}

Regression regress_paper(const LandmarkModel& model, const SurfaceAnalysis& analysis, int32_t landmark,
                         const SurfacePoint& truth, const Execution& execution) {
  const MarkedShape marked{analysis.proxy.coarse, {truth}};
  Regression best{{}, normalised_targets(marked, analysis, execution).col(0)};
  const Vector side = signed_sides(symmetry_plane(analysis.surface(), analysis.params.seed, execution),
                                   analysis.surface().positions);
  for (const double sign : {1.0, -1.0}) {
    const RowMatrixf descriptors = with_sides(analysis.descriptors, analysis.samples, side, sign);
    Eigen::VectorXf regressed = predict_means(model.forests[landmark], descriptors, execution);
    if (sign > 0 || (regressed - best.truth).squaredNorm() < (best.regressed - best.truth).squaredNorm())
      best.regressed = std::move(regressed);
  }
  return best;
}

}  // namespace focal
