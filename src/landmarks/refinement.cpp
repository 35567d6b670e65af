#include "landmarks/refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/closest_point.h"
#include "mesh/prepare.h"

namespace focal {
namespace {

constexpr float reach = 0.08f;  // in sqrt(area): the separation of the peaks, so the correct one is within it
constexpr float border = 0.02f;  // width in which vertices fade out, so that no vertex enters abruptly
// Chosen by cross-validation on training splits of faust5k, teddy, ant, human07 and lion:
constexpr double vote_weight = 10;  // relative to the mean squared deviation of the distances
constexpr double deviation_clip = 8;
constexpr int32_t rounds = 2;        // because the other landmarks move too
constexpr double temperature = 0.3;  // of the mean place
// Weight of distances to a known landmark, relative to others. Two folds of the training splits of ant, teddy
// and human07: docs/accuracy.md.
constexpr double fixed_weight = 4;

// Cost of placing one landmark at each vertex near its current place.
struct Region {
  std::vector<int32_t> vertex;
  std::vector<double> cost, share;  // share: 1, down to 0 at the border
};

double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

// fields: placed landmarks x vertices.
Region region_of(const ConstellationStatistics& statistics, const Placement& placement,
                 const RowMatrixf& fields, const std::vector<int32_t>& placed, size_t p) {
  const int32_t l = placed[p];
  const RowMatrixf& votes = placement.votes;
  std::vector<size_t> others;
  for (size_t o = 0; o < placed.size(); ++o)
    if (o != p && !placement.features[placed[o]].left_out) others.push_back(o);
  Region region;
  float largest = std::numeric_limits<float>::min();
  for (int32_t v = 0; v < fields.cols(); ++v)
    if (fields(p, v) < reach) {
      const double share = smooth_step((reach - fields(p, v)) / border);
      region.vertex.push_back(v), region.share.push_back(share);
      largest = std::max(largest, static_cast<float>(share) * votes(v, l));
    }
  for (const int32_t v : region.vertex) {
    double deviation = 0, total = 0;
    for (const size_t o : others) {
      const double weight = placement.is_fixed(placed[o]) ? fixed_weight : 1;
      const double z =
          (fields(o, v) - statistics.distance_mean(l, placed[o])) / statistics.distance_sd(l, placed[o]);
      deviation += weight * std::min(z * z / 2, deviation_clip), total += weight;
    }
    region.cost.push_back(vote_weight * (1 - votes(v, l) / largest) + deviation / std::max(total, 1.0));
  }
  return region;
}

// The mean of the region's places, weighted by exp(-cost / temperature) and projected to the surface, on the
// side that most of them are on. A thin part has two sides: a place counts by how well its normal agrees.
SurfacePoint mean_place(const SurfaceAnalysis& analysis, const MatrixX3& normals, const Region& region,
                        const SurfacePoint& before) {
  constexpr double facing = 0.2;  // cosine of the angle below which a place counts fully
  const TriangleMesh& mesh = analysis.surface();
  if (region.vertex.empty()) return before;  // all vertices of a large triangle are out of reach
  const double lowest = *std::min_element(region.cost.begin(), region.cost.end());
  std::vector<double> weight;
  Eigen::RowVector3d side = Eigen::RowVector3d::Zero();
  for (size_t i = 0; i < region.vertex.size(); ++i) {
    const int32_t v = region.vertex[i];
    weight.push_back(region.share[i] * analysis.operators.mass[v] *
                     std::exp((lowest - region.cost[i]) / temperature));
    side += weight[i] * weight[i] * normals.row(v);
  }
  side.normalize();
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  double total = 0;
  for (size_t i = 0; i < region.vertex.size(); ++i) {
    const int32_t v = region.vertex[i];
    const double w = weight[i] * (1e-6 + smooth_step(normals.row(v).dot(side) / facing));
    sum += w * mesh.positions.row(v), total += w;
  }
  if (!(total > 0)) return before;
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
  auto points = points_at(analysis.surface(), vertex);
  for (size_t p = 0; p < placed.size(); ++p) {
    if (placement.is_fixed(placed[p])) points[p] = *placement.fixed[placed[p]];
    placement.point[placed[p]] = points[p];
  }
  if (placed.size() < 2) return;
  MatrixX3 normals = area_normals(analysis.surface());
  for (Eigen::Index v = 0; v < normals.rows(); ++v) normals.row(v).normalize();
  for (int32_t round = 0; round < rounds; ++round) {
    const RowMatrixf fields = analysis.metric->distances(points, execution);
    parallel_for(execution, static_cast<int64_t>(placed.size()), [&](int64_t p) {
      if (placement.is_fixed(placed[p])) return;
      points[p] =
          mean_place(analysis, normals,
                     region_of(statistics, placement, fields, placed, static_cast<size_t>(p)), points[p]);
    });
  }
  for (size_t p = 0; p < placed.size(); ++p) {
    placement.point[placed[p]] = points[p];
    placement.vertex[placed[p]] = nearest_corner(analysis.surface(), points[p]);
  }
}

}  // namespace focal
