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

// All chosen by cross-validation on training splits of nine categories; the errors are flat round them.
constexpr CarryParams thorough{.map = {.first = 20, .last = 120, .step = 8}, .most_alike = 0};
constexpr CarryParams quick{.map = {.first = 20, .last = 120, .step = 20}, .spread = 600, .most_alike = 3};
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

// How much the map of each training shape counts.
std::vector<double> weights_of(const std::vector<CarriedMarks>& carried) {
  float least = std::numeric_limits<float>::infinity();
  for (const auto& shape : carried) least = std::min(least, shape.residual);
  std::vector<double> weights;
  for (const auto& shape : carried) weights.push_back(std::exp(-alike_falloff * (shape.residual - least)));
  return weights;
}

// The landmark's own place, as one more shape of mean weight, and its marks on the training shapes. own_share: of that
// weight, which counts.
std::vector<Opinion> opinions_on(int32_t landmark, const SurfacePoint& own, double own_share,
                                 const TriangleMesh& surface, const std::vector<CarriedMarks>& carried,
                                 const std::vector<double>& weights) {
  const double mean =
      std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
  std::vector<Opinion> opinions = {{position_of(surface, own), own_share * mean, own.triangle}};
  for (size_t s = 0; s < carried.size(); ++s)
    if (const auto& point = carried[s].point[landmark])
      opinions.push_back({position_of(surface, *point), weights[s], point->triangle});
  return opinions;
}

// Maps of the training shapes that start from the landmarks that were not left out; nothing when those are
// too few to start from.
std::vector<ShapeMap> maps_from(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                const Placement& placement, const CarryParams& params, const Execution& execution) {
  std::vector<int32_t> trusted;
  std::vector<SurfacePoint> starts;
  for (size_t l = 0; l < placement.vertex.size(); ++l) {
    if (placement.vertex[l] < 0 || placement.evidence[l].left_out) continue;
    trusted.push_back(static_cast<int32_t>(l)), starts.push_back(placement.point[l]);
  }
  if (model.atlas.empty() || trusted.size() < 3) return {};
  return map_shapes(model.atlas, placement.exemplars, model.reach, analysis, trusted,
                    analysis.metric->distances(starts, execution), params, execution);
}

float mean_residual(const std::vector<CarriedMarks>& carried) {
  float sum = 0;
  for (const auto& shape : carried) sum += shape.residual / static_cast<float>(carried.size());
  return sum;
}

float mean_bulge_agreement(const std::vector<CarriedMarks>& carried) {
  float sum = 0;
  for (const auto& shape : carried) sum += shape.bulge_agreement / static_cast<float>(carried.size());
  return sum;
}

}  // namespace

MapFit quick_map_fit(const LandmarkModel& model, const SurfaceAnalysis& analysis, const Placement& placement,
                     const Execution& execution) {
  const auto carried =
      carry_marks(model.atlas, maps_from(model, analysis, placement, quick, execution), analysis, execution);
  if (carried.empty()) return {std::numeric_limits<double>::infinity(), 0};
  return {mean_residual(carried), mean_bulge_agreement(carried)};
}

void join_carried_marks(const LandmarkModel& model, const SurfaceAnalysis& analysis, Quality quality,
                        Placement& placement, const Execution& execution) {
  const bool best = quality == Quality::best;
  auto maps = maps_from(model, analysis, placement, best ? thorough : quick, execution);
  const auto carried = carry_marks(model.atlas, maps, analysis, execution);
  if (carried.empty()) return;
  if (best) placement.map_residual = mean_residual(carried), placement.maps = std::move(maps);
  placement.bulge_agreement = mean_bulge_agreement(carried);
  std::vector<int32_t> placed;
  for (size_t l = 0; l < placement.vertex.size(); ++l)
    if (placement.vertex[l] >= 0) placed.push_back(static_cast<int32_t>(l));
  const std::vector<double> weights = weights_of(carried);
  const TriangleMesh& surface = analysis.surface();
  const MatrixX3 normals = face_normals(surface);
  std::vector<SurfaceQuery> queries;
  for (size_t p = 0; p < placed.size(); ++p) {
    Evidence& evidence = placement.evidence[placed[p]];
    const auto opinions = opinions_on(placed[p], placement.point[placed[p]], evidence.left_out ? 1e-3 : 1,
                                      surface, carried, weights);
    const Consensus consensus = consensus_of(opinions);
    if (best) {  // what a few shapes say differs from what confidence was learned on
      evidence.spread = static_cast<float>(consensus.spread);
      evidence.gap = static_cast<float>((consensus.position - opinions[0].position).norm());
    }
    queries.push_back({consensus.position, normals.row(consensus.triangle).transpose()});
  }
  const auto points = closest_points(surface, queries, 2 * analysis.operators.mean_edge);
  for (size_t p = 0; p < placed.size(); ++p) {
    if (placement.is_fixed(placed[p])) continue;
    placement.point[placed[p]] = points[p];
    placement.vertex[placed[p]] = nearest_corner(surface, points[p]);
  }
}

}  // namespace focal
