#include "landmarks/refine.h"

#include <algorithm>
#include <limits>

namespace focal {
namespace {

constexpr float reach = 0.08f;  // of sqrt(area): the separation of the peaks, so the right one is within it
constexpr double vote_weight = 20;    // against the mean squared deviation of the distances; both chosen by
constexpr double deviation_clip = 8;  // cross-validation on training splits of faust5k, teddy and scape
constexpr int32_t rounds = 2;         // the others have moved too

// Vertex within reach of landmark placed[p] with the lowest cost; fields: placed landmarks x vertices.
int32_t best_nearby(const ConstellationStatistics& statistics, const RowMatrixf& votes,
                    const RowMatrixf& fields, const std::vector<int32_t>& placed, size_t p) {
  const int32_t l = placed[p];
  std::vector<int32_t> region;
  float largest = std::numeric_limits<float>::min();
  for (int32_t v = 0; v < fields.cols(); ++v)
    if (fields(p, v) < reach) region.push_back(v), largest = std::max(largest, votes(v, l));
  double best = std::numeric_limits<double>::infinity();
  int32_t best_vertex = -1;
  for (const int32_t v : region) {
    double deviation = 0;
    for (size_t o = 0; o < placed.size(); ++o) {
      if (o == p) continue;
      const double z =
          (fields(o, v) - statistics.distance_mean(l, placed[o])) / statistics.distance_sd(l, placed[o]);
      deviation += std::min(z * z / 2, deviation_clip);
    }
    const double cost =
        vote_weight * (1 - votes(v, l) / largest) + deviation / static_cast<double>(placed.size() - 1);
    if (cost < best) best = cost, best_vertex = v;
  }
  return best_vertex;
}

}  // namespace

void refine_placement(const ConstellationStatistics& statistics, const SurfaceAnalysis& analysis,
                      Placement& placement, const Execution& execution) {
  std::vector<int32_t> placed, vertex;
  for (int32_t l = 0; l < static_cast<int32_t>(placement.vertex.size()); ++l)
    if (placement.vertex[l] >= 0) placed.push_back(l), vertex.push_back(placement.vertex[l]);
  if (placed.size() < 2) return;
  for (int32_t round = 0; round < rounds; ++round) {
    const RowMatrixf fields = analysis.heat.distances(vertex, execution);
    parallel_for(execution, static_cast<int64_t>(placed.size()), [&](int64_t p) {
      vertex[p] = best_nearby(statistics, placement.votes, fields, placed, static_cast<size_t>(p));
    });
  }
  for (size_t p = 0; p < placed.size(); ++p) placement.vertex[placed[p]] = vertex[p];
}

}  // namespace focal
