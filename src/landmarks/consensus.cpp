#include "landmarks/consensus.h"

#include <algorithm>
#include <cmath>

#include "mesh/closest_point.h"
#include "mesh/prepare.h"
#include "operators/operators.h"

namespace focal {
namespace {

// All chosen by cross-validation on training splits of nine categories; the errors are flat round them.
constexpr MapParams full_maps{.first = 20, .last = 120, .step = 8};
constexpr double alike_falloff = 30;       // a map counts exp(-falloff (residual - least residual))
constexpr double outlier_distance = 0.03;  // of sqrt(area): marks farther from the consensus count less
constexpr int rounds = 8;                  // of reweighting

struct Opinion {
  Vector3 position;
  double weight;
  int32_t triangle;
};

struct Consensus {
  Vector3 position;
  double spread;     // root mean squared distance of the opinions, outliers counting less
  int32_t triangle;  // of the opinion nearest to all others
};

size_t medoid(const std::vector<Opinion>& opinions) {
  std::vector<double> cost;
  for (const auto& a : opinions) {
    cost.push_back(0);
    for (const auto& b : opinions) cost.back() += b.weight * (a.position - b.position).norm();
  }
  return static_cast<size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
}

// A robust mean: Cauchy weights round the place found so far, from the medoid on.
Consensus consensus_of(const std::vector<Opinion>& opinions) {
  const Opinion& first = opinions[medoid(opinions)];
  Consensus result{first.position, 0, first.triangle};
  for (int round = 0; round < rounds; ++round) {
    Vector3 sum = Vector3::Zero();
    double total = 0, square = 0;
    for (const auto& opinion : opinions) {
      const double away = (opinion.position - result.position).norm();
      const double weight = opinion.weight / (1 + std::pow(away / outlier_distance, 2));
      sum += weight * opinion.position, total += weight, square += weight * away * away;
    }
    result.position = sum / total;
    result.spread = std::sqrt(square / total);
  }
  return result;
}

struct Placed {
  std::vector<int32_t> landmark;
  std::vector<SurfacePoint> point;
};

double mean_residual(const std::vector<CarriedMarks>& carried) {
  double sum = 0;
  for (const auto& shape : carried) sum += shape.residual;
  return sum / static_cast<double>(carried.size());
}

}  // namespace

void join_carried_marks(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                        const SpectralTargets& targets, Placement& placement, const Execution& execution) {
  Placed placed;
  for (size_t l = 0; l < placement.vertex.size(); ++l)
    if (placement.vertex[l] >= 0)
      placed.landmark.push_back(static_cast<int32_t>(l)), placed.point.push_back(placement.point[l]);
  if (placed.landmark.size() < 3) return;  // too few to start a map from
  const RowMatrixf fields = analysis.heat.distances(placed.point, execution);
  const auto carried =
      carry_marks(model.atlas, model.reach, analysis, targets, placed.landmark, fields, full_maps, execution);
  double least = std::numeric_limits<double>::infinity(), sum = 0;
  std::vector<double> alike;
  for (const auto& shape : carried) least = std::min<double>(least, shape.residual);
  for (const auto& shape : carried) alike.push_back(std::exp(-alike_falloff * (shape.residual - least)));
  for (const double weight : alike) sum += weight;
  placement.map_residual = static_cast<float>(mean_residual(carried));
  const auto& surface = analysis.surface();
  const MatrixX3 normals = face_normals(surface);
  std::vector<SurfaceQuery> queries;
  for (const int32_t l : placed.landmark) {
    const SurfacePoint& own = placement.point[l];
    std::vector<Opinion> opinions = {
        {position_of(surface, own), sum / static_cast<double>(carried.size()), own.triangle}};
    for (size_t s = 0; s < carried.size(); ++s)
      if (const auto& point = carried[s].point[l])
        opinions.push_back({position_of(surface, *point), alike[s], point->triangle});
    const Consensus consensus = consensus_of(opinions);
    placement.evidence[l].spread = static_cast<float>(consensus.spread);
    placement.evidence[l].gap = static_cast<float>((consensus.position - opinions[0].position).norm());
    queries.push_back({consensus.position, normals.row(consensus.triangle).transpose()});
  }
  const auto points = closest_points(surface, queries, 2 * analysis.operators.mean_edge);
  for (size_t p = 0; p < points.size(); ++p) {
    const int32_t l = placed.landmark[p];
    placement.point[l] = points[p];
    int nearest = 0;
    points[p].barycentric.maxCoeff(&nearest);
    placement.vertex[l] = surface.triangles(points[p].triangle, nearest);
  }
}

}  // namespace focal
