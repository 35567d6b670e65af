#include "landmarks/refine.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/closest_point.h"
#include "mesh/prepare.h"

namespace focal {
namespace {

constexpr float reach = 0.08f;  // of sqrt(area): the separation of the peaks, so the right one is within it
// Chosen by cross-validation on training splits of faust5k, teddy, ant, human07 and lion:
constexpr double vote_weight = 10;  // against the mean squared deviation of the distances
constexpr double deviation_clip = 8;
constexpr int32_t rounds = 2;        // the others have moved too
constexpr double temperature = 0.3;  // of the mean place

// Cost of placing one landmark at each vertex near its present place.
struct Region {
  std::vector<int32_t> vertex;
  std::vector<double> cost;
  int32_t best() const { return vertex[std::min_element(cost.begin(), cost.end()) - cost.begin()]; }
};

// fields: placed landmarks x vertices.
Region region_of(const ConstellationStatistics& statistics, const Placement& placement,
                 const RowMatrixf& fields, const std::vector<int32_t>& placed, size_t p) {
  const int32_t l = placed[p];
  const RowMatrixf& votes = placement.votes;
  std::vector<size_t> others;
  for (size_t o = 0; o < placed.size(); ++o)
    if (o != p && !placement.evidence[placed[o]].left_out) others.push_back(o);
  Region region;
  float largest = std::numeric_limits<float>::min();
  for (int32_t v = 0; v < fields.cols(); ++v)
    if (fields(p, v) < reach) region.vertex.push_back(v), largest = std::max(largest, votes(v, l));
  for (const int32_t v : region.vertex) {
    double deviation = 0;
    for (const size_t o : others) {
      const double z =
          (fields(o, v) - statistics.distance_mean(l, placed[o])) / statistics.distance_sd(l, placed[o]);
      deviation += std::min(z * z / 2, deviation_clip);
    }
    region.cost.push_back(vote_weight * (1 - votes(v, l) / largest) +
                          deviation / static_cast<double>(std::max<size_t>(others.size(), 1)));
  }
  return region;
}

// The mean of the region's places, each as likely as exp(-cost / temperature), on the surface; the side of the best one.
SurfacePoint mean_place(const SurfaceAnalysis& analysis, const MatrixX3& normals, const Region& region) {
  const TriangleMesh& mesh = analysis.surface();
  const int32_t best = region.best();
  const Eigen::RowVector3d side = normals.row(best);
  const double lowest = *std::min_element(region.cost.begin(), region.cost.end());
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  double total = 0;
  for (size_t i = 0; i < region.vertex.size(); ++i) {
    const int32_t v = region.vertex[i];
    if (v != best && normals.row(v).dot(side) <= 0)
      continue;  // a side may face nowhere, as where sheets meet
    const double weight = analysis.operators.mass[v] * std::exp((lowest - region.cost[i]) / temperature);
    sum += weight * mesh.positions.row(v), total += weight;
  }
  const SurfaceQuery query{(sum / total).transpose(), side.transpose()};
  return closest_points(mesh, std::span(&query, 1), 2 * analysis.operators.mean_edge)[0];
}

}  // namespace

void refine_placement(const ConstellationStatistics& statistics, const SurfaceAnalysis& analysis,
                      Placement& placement, const Execution& execution) {
  std::vector<int32_t> placed, vertex;
  for (int32_t l = 0; l < static_cast<int32_t>(placement.vertex.size()); ++l)
    if (placement.vertex[l] >= 0) placed.push_back(l), vertex.push_back(placement.vertex[l]);
  placement.point.assign(placement.vertex.size(), {});
  const auto at_vertices = points_at(analysis.surface(), vertex);
  for (size_t p = 0; p < placed.size(); ++p)
    placement.point[placed[p]] = placement.is_fixed(placed[p]) ? *placement.fixed[placed[p]] : at_vertices[p];
  if (placed.size() < 2) return;
  const MatrixX3 normals = area_normals(analysis.surface());
  for (int32_t round = 0; round < rounds; ++round) {
    const RowMatrixf fields = analysis.metric->distances(vertex, execution);
    parallel_for(execution, static_cast<int64_t>(placed.size()), [&](int64_t p) {
      if (placement.is_fixed(placed[p])) return;
      const Region region = region_of(statistics, placement, fields, placed, static_cast<size_t>(p));
      vertex[p] = region.best();
      if (round + 1 == rounds) placement.point[placed[p]] = mean_place(analysis, normals, region);
    });
  }
  for (size_t p = 0; p < placed.size(); ++p) placement.vertex[placed[p]] = vertex[p];
}

}  // namespace focal
