#include "landmarks/shape_starts.h"

#include <algorithm>
#include <cmath>

#include "mesh/closest_point.h"
#include "mesh/nearest_vertex.h"

namespace focal {
namespace {

constexpr int32_t compared_points = 400;  // of either shape
constexpr double max_stretch = 0.4;       // logarithm of the scale of one axis relative to the mean scale
// In sqrt(area), beyond the nearest point: points within it determine the position of a landmark.
constexpr float mark_radius = 0.05f;

// The shape's points with the mean and, within limits, the extents of the other shape.
MatrixX3 laid_over(const MatrixX3& points, const Vector& weight, const Extents& other) {
  const Extents own = extents_of(points, weight);
  return ((points.rowwise() - own.mean.transpose()) * scale_onto(own, other).asDiagonal()).rowwise() +
         other.mean.transpose();
}

// Mean distance of a subset of points from the nearest point of a tree.
double mean_distance(const MatrixX3& points, const Vector& weight, const NearestVertex& tree) {
  const Eigen::Index stride = std::max<Eigen::Index>(points.rows() / compared_points, 1);
  double sum = 0, total = 0;
  for (Eigen::Index i = 0; i < points.rows(); i += stride) {
    sum += weight[i] * std::sqrt(tree.nearest(points.row(i)).second);
    total += weight[i];
  }
  return sum / total;
}

// Mean position of the points nearest to the landmark.
Vector3 place_of_mark(const Exemplar& shape, float reach, int32_t landmark, const MatrixX3& laid) {
  const Eigen::VectorXf away =
      shape.distances.col(landmark).head(laid.rows()).cast<float>() * (reach / target_steps);
  const float limit = away.minCoeff() + mark_radius;
  Vector3 sum = Vector3::Zero();
  double total = 0;
  for (Eigen::Index i = 0; i < laid.rows(); ++i)
    if (away[i] < limit) {
      const double weight = std::pow(1 - away[i] / limit, 2);
      sum += weight * laid.row(i).transpose(), total += weight;
    }
  return sum / total;
}

std::vector<SurfacePoint> places_by(const Exemplar& shape, float reach, const MatrixX3& laid,
                                    const Matrix3& frame, const SurfaceAnalysis& analysis) {
  std::vector<SurfacePoint> result(shape.marked.size(), SurfacePoint{.triangle = -1});
  std::vector<SurfaceQuery> queries;
  for (size_t l = 0; l < shape.marked.size(); ++l)
    if (shape.marked[l])
      queries.push_back(
          {frame.transpose() * place_of_mark(shape, reach, static_cast<int32_t>(l), laid), Vector3::Zero()});
  const auto points = closest_points(analysis.surface(), queries, 4 * analysis.operators.mean_edge);
  size_t next = 0;
  for (size_t l = 0; l < shape.marked.size(); ++l)
    if (shape.marked[l]) result[l] = points[next++];
  return result;
}

}  // namespace

Extents extents_of(const MatrixX3& points, const Vector& weight) {
  const Vector3 mean = points.transpose() * weight / weight.sum();
  const MatrixX3 away = points.rowwise() - mean.transpose();
  return {mean, ((away.array().square().matrix().transpose() * weight) / weight.sum()).array().sqrt()};
}

Vector3 scale_onto(const Extents& shape, const Extents& other) {
  Vector3 scale = other.deviation.cwiseQuotient(shape.deviation.cwiseMax(1e-9)).cwiseMax(1e-9);
  const double all = std::cbrt(scale.prod());
  for (double& one : scale) one = all * std::exp(std::clamp(std::log(one / all), -max_stretch, max_stretch));
  return scale;
}

bool can_be_laid_over(const LandmarkModel& model) {
  return model.params.oriented && std::any_of(model.exemplars.begin(), model.exemplars.end(),
                                              [](const Exemplar& one) { return one.positions.rows() > 0; });
}

ShapeStarts lay_shapes_over(const LandmarkModel& model, const SurfaceAnalysis& analysis, const Matrix3& frame,
                            size_t exemplars, size_t starts, const Execution& execution) {
  ShapeStarts result;
  for (size_t s = 0; s < model.exemplars.size(); ++s)
    if (model.exemplars[s].positions.rows() > 0) result.exemplars.push_back(static_cast<int32_t>(s));
  const MatrixX3 body = analysis.surface().positions * frame.transpose();
  const Vector& mass = analysis.operators.mass;
  const NearestVertex tree(body);
  const Extents extents = extents_of(body, mass);
  std::vector<MatrixX3> laid(model.exemplars.size());
  std::vector<double> apart(model.exemplars.size());
  parallel_for(execution, static_cast<int64_t>(result.exemplars.size()), [&](int64_t i) {
    const int32_t s = result.exemplars[i];
    const Exemplar& shape = model.exemplars[s];
    const Vector weight = shape.samples.weight.head(shape.positions.rows()).cast<double>();
    laid[s] = laid_over(shape.positions, weight, extents);
    const NearestVertex own(laid[s]);
    apart[s] = mean_distance(laid[s], weight, tree) + mean_distance(body, mass, own);
  });
  std::stable_sort(result.exemplars.begin(), result.exemplars.end(),
                   [&](int32_t a, int32_t b) { return apart[a] < apart[b]; });
  result.apart = apart[result.exemplars[0]];
  result.exemplars.resize(std::min(exemplars, result.exemplars.size()));
  for (size_t i = 0; i < std::min(starts, result.exemplars.size()); ++i) {
    const int32_t s = result.exemplars[i];
    result.places.push_back(places_by(model.exemplars[s], model.reach, laid[s], frame, analysis));
  }
  return result;
}

}  // namespace focal
