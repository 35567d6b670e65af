#include "landmarks/orientation.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "landmarks/features.h"

namespace focal {
namespace {

constexpr double turned_penalty = 11;   // for not facing +Z, in units of energy; few files do not
constexpr double tilted_penalty = 30;   // for not standing upright, likewise
constexpr double facing_weight = 160;   // of the correlation of the normals, relative to energies
constexpr double clearly_tilted = 0.6;  // required advantage in correlation of another up axis

// For each row of features the expected position and normal in the body's frame: the mean over the leaves.
RowMatrixf expected_places(const RegressionForest& forest, const RowMatrixf& targets,
                           const RowMatrixf& features) {
  RowMatrixf result = RowMatrixf::Zero(features.rows(), targets.cols());
  for (Eigen::Index s = 0; s < features.rows(); ++s)
    for (const RegressionTree& tree : forest.trees) {
      const int32_t leaf = tree.leaf_of(features.row(s).data());
      const int32_t begin = tree.leaf_start[leaf], end = tree.leaf_start[leaf + 1];
      const float share =
          1.0f / static_cast<float>((end - begin) * static_cast<int64_t>(forest.trees.size()));
      for (int32_t i = begin; i < end; ++i) result.row(s) += share * targets.row(tree.leaf_samples[i]);
    }
  return result;
}

// Sum over samples of expected x observed, one entry per pair of axes, positions and normals together; within
// -1..1. known, used: 1 for the axes that count.
Matrix3 correlation(const RowMatrixf& expected, const RowMatrixf& seen, const Eigen::RowVector3f& known,
                    const Eigen::RowVector3f& used) {
  Matrix3 sum = Matrix3::Zero();
  for (const Eigen::Index first : {0, 3}) {
    const RowMatrixf e = expected.middleCols<3>(first) * known.asDiagonal(),
                     o = seen.middleCols<3>(first) * used.asDiagonal();
    const double size = std::sqrt(static_cast<double>(e.squaredNorm()) * o.squaredNorm());
    if (size > 0) sum += (e.transpose() * o).cast<double>() / size;
  }
  return sum;
}

RowMatrixf turned(RowMatrixf placed, const Matrix3& by) {
  const Eigen::Matrix3f turn = by.cast<float>().transpose();
  placed.leftCols<3>() *= turn, placed.rightCols<3>() *= turn;
  return placed;
}

// The rotation that best aligns the observed with the expected vectors.
Matrix3 best_turn(const Matrix3& correlation) {
  const Eigen::JacobiSVD<Matrix3> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Vector3(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

double fit(const Matrix3& correlation, const Matrix3& turn) {
  return (turn.transpose() * correlation).trace();
}

// The best fit over all rotations about the y axis.
double best_upright_fit(const Matrix3& correlation) {
  return correlation(1, 1) +
         std::hypot(correlation(0, 0) + correlation(2, 2), correlation(0, 2) - correlation(2, 0));
}

Matrix3 about_up(double angle) { return Eigen::AngleAxisd(angle, Vector3::UnitY()).toRotationMatrix(); }

// Candidate headings of a body that is upright in `placed`: as it is, reversed, and the estimated ones.
std::vector<Heading> headings_about_up(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                       const Described& of, const RowMatrixf& placed, double prior) {
  const RowMatrixf features = upright_features(analysis, of, placed);
  // The features do not distinguish left from right: across the up axis they only predict front and back.
  const Matrix3 seen = correlation(expected_places(model.facing, model.facing_targets, features), placed,
                                   {0, 0, 1}, {1, 0, 1});
  const double best = std::atan2(seen(0, 2) - seen(2, 0), seen(0, 0) + seen(2, 2));
  const auto penalty = [&](double angle) {
    const bool is_usual = std::abs(std::remainder(angle, 2 * EIGEN_PI)) < 0.5;
    return (is_usual ? 0 : prior) - facing_weight * fit(seen, about_up(angle));
  };
  const auto heading = [&](double angle) -> Heading {
    return {about_up(angle), penalty(angle), penalty(angle + EIGEN_PI) - penalty(angle)};
  };
  std::vector<Heading> result{heading(0), heading(EIGEN_PI)};
  if (std::abs(best) > 0.6 && std::abs(best) < EIGEN_PI - 0.6) result.push_back(heading(best));
  return result;
}

}  // namespace

std::vector<Heading> headings_to_try(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                     DetectParams::Orientation orientation) {
  if (!model.params.oriented || !model.params.finds_heading) return {Heading{}};
  const bool is_any = orientation == DetectParams::Orientation::any;
  const DescribedVertices& spread = analysis.described;
  const Described of = spread.vertices.empty()
                           ? first_samples(analysis, static_cast<int32_t>(analysis.samples.size()))
                           : Described{spread.vertices, spread.descriptors};
  const RowMatrixf placed = placed_features(analysis, of.vertices);
  std::vector<Heading> result = headings_about_up(model, analysis, of, placed, is_any ? 0 : turned_penalty);
  const Matrix3 risen =
      correlation(expected_places(model.rising, model.facing_targets, invariant_features(analysis, of)),
                  placed, {1, 1, 1}, {1, 1, 1});
  const Matrix3 turn = best_turn(risen);
  if (is_any || fit(risen, turn) > best_upright_fit(risen) + clearly_tilted)
    for (Heading& heading : headings_about_up(model, analysis, of, turned(placed, turn), 0)) {
      heading.frame = heading.frame * turn;
      heading.penalty += is_any ? 0 : tilted_penalty;
      result.push_back(heading);
    }
  return result;
}

void learn_orientation(LandmarkModel& model, const std::vector<const SurfaceAnalysis*>& meshes,
                       const Execution& execution) {
  constexpr int32_t most = 20000;
  const int32_t share = std::max<int32_t>(most / static_cast<int32_t>(meshes.size()), 50);
  const auto count_of = [&](const SurfaceAnalysis* mesh) {
    return std::min(share, static_cast<int32_t>(mesh->samples.size()));
  };
  Eigen::Index rows = 0;
  for (const SurfaceAnalysis* mesh : meshes) rows += count_of(mesh);
  RowMatrixf invariant(rows, invariant_feature_count(model.params)),
      upright(rows, upright_feature_count(model.params));
  model.facing_targets.resize(rows, 6);
  Eigen::Index row = 0;
  for (const SurfaceAnalysis* mesh : meshes) {
    const int32_t count = count_of(mesh);
    const Described of = first_samples(*mesh, count);
    const RowMatrixf placed = placed_features(*mesh, of.vertices);
    invariant.middleRows(row, count) = invariant_features(*mesh, of);
    upright.middleRows(row, count) = upright_features(*mesh, of, placed);
    model.facing_targets.middleRows(row, count) =
        placed.unaryExpr([](float value) { return place_from_file(place_to_file(value)); });
    row += count;
  }
  const ForestParams forest{.tree_count = 12,
                            .min_leaf_samples = 8,
                            .min_split_samples = 16,
                            .components_per_split = 8,
                            .seed = model.params.seed + 1};
  model.rising = grow_forest(bin_descriptors(invariant, execution), model.facing_targets, forest, execution);
  RowMatrixf forwards = model.facing_targets;  // only front and back are learned
  for (const Eigen::Index other : {0, 1, 3, 4}) forwards.col(other).setZero();
  model.facing = grow_forest(bin_descriptors(upright, execution), forwards, forest, execution);
}

}  // namespace focal
