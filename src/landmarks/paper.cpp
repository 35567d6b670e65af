#include "landmarks/paper.h"

#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"
#include "landmarks/backend_surface.h"
#include "symmetry/symmetry_plane.h"
#include "vote/vote.h"

namespace focal {
namespace {

constexpr int lanes = Distance::lanes;
constexpr double isoline_decay = 5;     // Section 5: weight factor
constexpr float neighbourhood = 0.02f;  // Section 5: radius over which votes are averaged

// +1 on the side to which the symmetry plane's normal points, -1 on the other (Section 4.1).
Vector signed_sides(const SymmetryPlane& plane, const MatrixX3& positions) {
  return (positions * plane.normal).array() - plane.offset;
}

// Section 4.1: on the side that the normal does not point to, the components stand in reverse order.
RowMatrixf with_sides(const RowMatrixf& descriptors, std::span<const int32_t> samples, const Vector& side,
                      double sign) {
  RowMatrixf result = descriptors;
  for (size_t s = 0; s < samples.size(); ++s)
    if (side[samples[s]] * sign < 0) result.row(s) = descriptors.row(s).reverse().eval();
  return result;
}

// The largest distance in each lane.
void largest_of(const float* distances, int32_t n, float* largest) {
  std::fill_n(largest, lanes, 1e-30f);
  for (int64_t v = 0; v < n; ++v)
    for (int j = 0; j < lanes; ++j) largest[j] = std::max(largest[j], distances[v * lanes + j]);
}

// samples x landmarks: distance from the sample to the mark over the sample's largest distance; NaN where not marked.
RowMatrixf normalised_targets(const MarkedShape& shape, const SurfaceAnalysis& analysis,
                              const Execution& execution) {
  RowMatrixf targets = RowMatrixf::Constant(analysis.samples.size(), shape.marks.size(), NAN);
  const int32_t n = analysis.metric->vertex_count();
  analysis.metric->for_each_block(
      analysis.samples, execution, [&](int64_t first, int32_t count, const float* distances) {
        float largest[lanes];
        largest_of(distances, n, largest);
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

// The normal's sign is not given in the paper. Ours: the side on which the marks agree with the first shape's.
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

// Forest of one landmark over the samples of the shapes on which it is marked.
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

// Votes of both signs, vertices x landmarks each.
struct TwoVotes {
  RowMatrixf sign[2];
};

TwoVotes cast_votes(const SurfaceAnalysis& analysis, const RowMatrixf radii[2], const Execution& execution) {
  const int32_t n = analysis.metric->vertex_count();
  const auto edges = edges_of(analysis.surface());
  constexpr int32_t parts = 8;  // fixed sums, added in order: the same bits for any number of threads
  TwoVotes total;
  for (auto& votes : total.sign) votes = RowMatrixf::Zero(n, radii[0].cols());
  const auto samples = static_cast<int32_t>(analysis.samples.size());
  for (int32_t from = 0; from < samples; from += parts * lanes) {
    const int32_t batch = std::min(parts * lanes, samples - from);
    std::vector<TwoVotes> partial(parts);
    analysis.metric->for_each_block(std::span(analysis.samples).subspan(from, batch), execution,
                                    [&](int64_t first, int32_t count, const float* distances) {
                                      float largest[lanes];
                                      largest_of(distances, n, largest);
                                      std::vector<float> scaled(static_cast<size_t>(n) * lanes);
                                      for (int64_t v = 0; v < n; ++v)
                                        for (int j = 0; j < lanes; ++j)
                                          scaled[v * lanes + j] = distances[v * lanes + j] / largest[j];
                                      for (int s = 0; s < 2; ++s) {
                                        RowMatrixf& votes = partial[first / lanes].sign[s];
                                        votes = RowMatrixf::Zero(n, radii[s].cols());
                                        add_isoline_votes(radii[s].middleRows(from + first, count),
                                                          scaled.data(), count, edges, isoline_decay, votes);
                                      }
                                    });
    for (const TwoVotes& part : partial)
      for (int s = 0; s < 2; ++s)
        if (part.sign[s].size()) total.sign[s] += part.sign[s];
    execution.report(static_cast<double>(from + batch) / samples);
  }
  return total;
}

// Mean vote over the vertices within 0.02 of each vertex' own largest distance (Section 5).
TwoVotes average_nearby(const TwoVotes& votes, const SurfaceAnalysis& analysis, const Execution& execution) {
  const int32_t n = analysis.metric->vertex_count();
  std::vector<int32_t> all(n);
  for (int32_t v = 0; v < n; ++v) all[v] = v;
  TwoVotes result;
  for (auto& mean : result.sign) mean = RowMatrixf::Zero(n, votes.sign[0].cols());
  analysis.metric->for_each_block(all, execution, [&](int64_t first, int32_t count, const float* distances) {
    float largest[lanes];
    largest_of(distances, n, largest);
    int32_t near[lanes] = {};
    for (int64_t v = 0; v < n; ++v)
      for (int32_t j = 0; j < count; ++j)
        if (distances[v * lanes + j] < neighbourhood * largest[j]) {
          ++near[j];
          for (int s = 0; s < 2; ++s) result.sign[s].row(first + j) += votes.sign[s].row(v);
        }
    for (int32_t j = 0; j < count; ++j)
      for (int s = 0; s < 2; ++s) result.sign[s].row(first + j) /= static_cast<float>(std::max(near[j], 1));
  });
  return result;
}

TwoVotes mean_votes(const SurfaceAnalysis& analysis, const RowMatrixf radii[2], const Execution& execution) {
  if (!analysis.on_backend)
    return average_nearby(cast_votes(analysis, radii, execution), analysis, execution);
  const Eigen::Index L = radii[0].cols();
  RowMatrixf both(radii[0].rows(), 2 * L);
  both << radii[0], radii[1];
  const RowMatrixf votes = analysis.on_backend->isoline_votes(analysis.samples, both, isoline_decay,
                                                              edges_of(analysis.surface()), neighbourhood);
  return {{votes.leftCols(L), votes.rightCols(L)}};
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

Placement place_landmarks_paper(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                const DetectParams& params, const Execution& execution,
                                StageSeconds& seconds) {
  Stopwatch watch;
  const auto L = static_cast<int32_t>(model.landmark_names.size());
  const Vector side =
      signed_sides(symmetry_plane(analysis.surface(), params.seed, execution), analysis.surface().positions);
  seconds.descriptors += watch.lap();
  RowMatrixf radii[2];
  for (int s = 0; s < 2; ++s) {
    const RowMatrixf descriptors = with_sides(analysis.descriptors, analysis.samples, side, s ? -1 : 1);
    radii[s].resize(descriptors.rows(), L);
    for (int32_t l = 0; l < L; ++l) radii[s].col(l) = predict_means(model.forests[l], descriptors, execution);
  }
  seconds.forest += watch.lap();
  const TwoVotes votes = mean_votes(analysis, radii, execution);
  seconds.vote += watch.lap();
  // "Higher total vote": the sum over the landmarks of the winning mean vote.
  const auto total = [&](int s) { return votes.sign[s].colwise().maxCoeff().sum(); };
  Placement result;
  result.votes = votes.sign[total(1) > total(0)];
  for (int32_t l = 0; l < L; ++l) {
    Eigen::Index best = 0;
    const float vote = result.votes.col(l).maxCoeff(&best);
    result.vertex.push_back(static_cast<int32_t>(best));
    result.rival.push_back(-1);
    result.evidence.push_back({.vote_ratio = 1,
                               .residual = 0,
                               .vote_level = vote / static_cast<float>(analysis.samples.size()),
                               .rival = 0});
  }
  result.point = points_at(analysis.surface(), result.vertex);
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
