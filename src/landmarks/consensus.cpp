#include "landmarks/consensus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "mesh/closest_point.h"
#include "mesh/prepare.h"
#include "operators/operators.h"

namespace focal {
namespace {

// All chosen by cross-validation on training splits of nine categories; the errors change little around them.
constexpr TransferParams thorough{.map = {.first = 20, .last = 120, .step = 8}, .most_alike = 0};
constexpr TransferParams quick{.map = {.first = 20, .last = 120, .step = 20}, .spread = 600, .most_alike = 3};
constexpr double alike_falloff = 30;  // weight of a map: exp(-falloff (residual - least residual))
// Maps with this residual are wrong half of the time, because of few landmarks or a very different body;
// worse ones do not count.
constexpr double doubtful_residual = 0.69, residual_width = 0.015;
// In sqrt(area): transferred landmarks farther from the consensus count less.
constexpr double outlier_distance = 0.03;
constexpr int rounds = 8;  // of reweighting
constexpr int median_rounds = 10;
// In sqrt(area): maps that transfer known landmarks with a larger error count less. Not tuned: 0.05 to 0.2
// make no difference on ants, nor does leaving it out there.
constexpr double wrong_map = 0.1;

struct Opinion {
  Vector3 position;
  double weight;
  Vector3 normal;
};

struct Consensus {
  Vector3 position;
  double spread;   // root mean squared distance of the opinions, outliers downweighted
  Vector3 normal;  // of the side of the surface that they are on
};

// Mean of the opinions, weighted by their distance from the current place.
template <class WeightAt>
Consensus weighted_mean(const std::vector<Opinion>& opinions, const Vector3& place,
                        const WeightAt& weight_at) {
  Consensus result{Vector3::Zero(), 0, Vector3::Zero()};
  double total = 0, square = 0;
  for (const auto& opinion : opinions) {
    const double away = (opinion.position - place).norm(), weight = opinion.weight * weight_at(away);
    result.position += weight * opinion.position, result.normal += weight * opinion.normal;
    total += weight, square += weight * away * away;
  }
  result.position /= total, result.spread = std::sqrt(square / total);
  return result;
}

// A robust mean: Cauchy weights around the current place, starting at the median (E. Weiszfeld, 1937). It
// never selects one opinion, so the place is continuous in the opinions.
Consensus consensus_of(const std::vector<Opinion>& opinions) {
  Consensus result = weighted_mean(opinions, opinions[0].position, [](double) { return 1.0; });
  for (int round = 0; round < median_rounds; ++round)
    result = weighted_mean(opinions, result.position,
                           [](double away) { return 1 / std::hypot(away, outlier_distance / 10); });
  for (int round = 0; round < rounds; ++round)
    result = weighted_mean(opinions, result.position,
                           [](double away) { return 1 / (1 + std::pow(away / outlier_distance, 2)); });
  return result;
}

Vector3 normal_at(const TriangleMesh& surface, const MatrixX3& normals, const SurfacePoint& point) {
  Vector3 sum = Vector3::Zero();
  for (int c = 0; c < 3; ++c)
    sum += point.barycentric[c] * normals.row(surface.triangles(point.triangle, c)).transpose().normalized();
  return sum;
}

// Weight of the map of each training shape.
std::vector<double> weights_of(const std::vector<TransferredLandmarks>& transferred) {
  float least = std::numeric_limits<float>::infinity();
  for (const auto& shape : transferred) least = std::min(least, shape.residual);
  std::vector<double> weights;
  for (const auto& shape : transferred)
    weights.push_back(std::exp(-alike_falloff * (shape.residual - least)));
  return weights;
}

double trust_in(const TransferredLandmarks& transferred) {
  return 1 / (1 + std::exp((transferred.residual - doubtful_residual) / residual_width));
}

// Squared distance from a known place to where a map transfers its landmark; 0 for a landmark that the shape
// lacks.
double squared_error(const SurfacePoint& place, const std::vector<TransferredPlace>& transferred,
                     const TriangleMesh& surface) {
  Vector3 sum = Vector3::Zero();
  double total = 0;
  for (const auto& [at, share] : transferred) sum += share * at.position, total += share;
  return total > 0 ? (position_of(surface, place) - sum / total).squaredNorm() : 0;
}

// Reduces the weight of maps that transfer known landmarks wrongly.
void trust_known(const Placement& placement, const TriangleMesh& surface,
                 const std::vector<TransferredLandmarks>& transferred, std::vector<double>& weights) {
  for (size_t s = 0; s < transferred.size(); ++s) {
    double squares = 0, known = 0;
    for (size_t l = 0; l < placement.fixed.size(); ++l)
      if (placement.is_fixed(l))
        squares += squared_error(*placement.fixed[l], transferred[s].places[l], surface), ++known;
    if (known > 0) weights[s] /= 1 + squares / known / (wrong_map * wrong_map);
  }
}

// The landmark's own place, as one more shape of mean weight, and its transferred places. own_share: factor
// on the own weight.
std::vector<Opinion> opinions_on(int32_t landmark, const SurfacePoint& own, double own_share,
                                 const TriangleMesh& surface, const MatrixX3& normals,
                                 const std::vector<TransferredLandmarks>& transferred,
                                 const std::vector<double>& weights) {
  const double mean =
      std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
  std::vector<Opinion> opinions = {
      {position_of(surface, own), own_share * mean, normal_at(surface, normals, own)}};
  for (size_t s = 0; s < transferred.size(); ++s)
    for (const auto& [at, share] : transferred[s].places[landmark])
      opinions.push_back(
          {at.position, weights[s] * share * trust_in(transferred[s]), at.normal.normalized()});
  return opinions;
}

// Maps of the training shapes, started from the landmarks that were not left out; empty when those are too
// few.
std::vector<ShapeMap> maps_from(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                const Placement& placement, const TransferParams& params,
                                const Execution& execution) {
  std::vector<int32_t> trusted;
  std::vector<SurfacePoint> starts;
  for (size_t l = 0; l < placement.vertex.size(); ++l) {
    if (placement.vertex[l] < 0 || placement.features[l].left_out) continue;
    trusted.push_back(static_cast<int32_t>(l)), starts.push_back(placement.point[l]);
  }
  if (model.exemplars.empty() || trusted.size() < 3) return {};
  return map_shapes(model.exemplars, placement.exemplars, model.reach, analysis, trusted,
                    analysis.metric->distances(starts, execution), params, execution);
}

MapFit fit_of(const LandmarkModel& model, const SurfaceAnalysis& analysis,
              const std::vector<ShapeMap>& maps) {
  if (maps.empty()) return {std::numeric_limits<double>::infinity(), 0};
  MapFit result;
  for (const ShapeMap& one : maps) {
    result.residual += one.map.residual / static_cast<double>(maps.size());
    result.bulge_agreement +=
        bulge_agreement(model.exemplars[one.shape], one.map, analysis) / static_cast<double>(maps.size());
  }
  return result;
}

}  // namespace

MapFit quick_map_fit(const LandmarkModel& model, const SurfaceAnalysis& analysis, const Placement& placement,
                     int32_t shapes, const Execution& execution) {
  TransferParams params = quick;
  params.most_alike = shapes;
  return fit_of(model, analysis, maps_from(model, analysis, placement, params, execution));
}

void join_transferred_landmarks(const LandmarkModel& model, const SurfaceAnalysis& analysis, Quality quality,
                                Placement& placement, const Execution& execution) {
  const bool best = quality == Quality::best;
  auto maps = maps_from(model, analysis, placement, best ? thorough : quick, execution);
  const auto transferred = transfer_landmarks(model.exemplars, maps, analysis, execution);
  if (transferred.empty()) return;
  const MapFit fit = fit_of(model, analysis, maps);
  placement.bulge_agreement = static_cast<float>(fit.bulge_agreement);
  if (best) placement.map_residual = static_cast<float>(fit.residual), placement.maps = std::move(maps);
  std::vector<int32_t> placed;
  for (size_t l = 0; l < placement.vertex.size(); ++l)
    if (placement.vertex[l] >= 0) placed.push_back(static_cast<int32_t>(l));
  std::vector<double> weights = weights_of(transferred);
  const TriangleMesh& surface = analysis.surface();
  trust_known(placement, surface, transferred, weights);
  const MatrixX3 normals = area_normals(surface);
  std::vector<SurfaceQuery> queries;
  for (size_t p = 0; p < placed.size(); ++p) {
    PlacementFeatures& features = placement.features[placed[p]];
    const auto opinions = opinions_on(placed[p], placement.point[placed[p]], features.left_out ? 1e-3 : 1,
                                      surface, normals, transferred, weights);
    const Consensus consensus = consensus_of(opinions);
    if (best) {  // features from a few shapes differ from those that confidence was trained on
      features.spread = static_cast<float>(consensus.spread);
      features.gap = static_cast<float>((consensus.position - opinions[0].position).norm());
    }
    queries.push_back({consensus.position, consensus.normal});
  }
  const auto points = closest_points(surface, queries, 2 * analysis.operators.mean_edge);
  for (size_t p = 0; p < placed.size(); ++p) {
    if (placement.is_fixed(placed[p])) continue;
    placement.point[placed[p]] = points[p];
    placement.vertex[placed[p]] = nearest_corner(surface, points[p]);
  }
}

}  // namespace focal
