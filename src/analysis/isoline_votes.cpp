#include "analysis/isoline_votes.h"

#include <algorithm>
#include <vector>

#include "vote/vote.h"

namespace focal {
namespace {

constexpr int lanes = Distance::lanes;

RowMatrixf cast_isoline_votes(const SurfaceAnalysis& analysis, const RowMatrixf& radii,
                              const Execution& execution) {
  const int32_t n = analysis.metric->vertex_count();
  const auto edges = edges_of(analysis.surface());
  // A fixed number of partial sums, added in order: the same bits for any number of threads.
  constexpr int32_t parts = 8;
  RowMatrixf total = RowMatrixf::Zero(n, radii.cols());
  const auto samples = static_cast<int32_t>(analysis.samples.size());
  for (int32_t from = 0; from < samples; from += parts * lanes) {
    const int32_t batch = std::min(parts * lanes, samples - from);
    std::vector<RowMatrixf> partial(parts);
    analysis.metric->for_each_block(std::span(analysis.samples).subspan(from, batch), execution,
                                    [&](int64_t first, int32_t count, const float* distances) {
                                      float largest[lanes];
                                      largest_distances(distances, n, largest);
                                      std::vector<float> scaled(static_cast<size_t>(n) * lanes);
                                      for (int64_t v = 0; v < n; ++v)
                                        for (int j = 0; j < lanes; ++j)
                                          scaled[v * lanes + j] = distances[v * lanes + j] / largest[j];
                                      RowMatrixf& votes = partial[first / lanes];
                                      votes = RowMatrixf::Zero(n, radii.cols());
                                      add_isoline_votes(radii.middleRows(from + first, count), scaled.data(),
                                                        count, edges, isoline_decay, votes);
                                    });
    for (const RowMatrixf& part : partial)
      if (part.size()) total += part;
    execution.report(static_cast<double>(from + batch) / samples);
  }
  return total;
}

RowMatrixf average_nearby(const RowMatrixf& votes, const SurfaceAnalysis& analysis,
                          const Execution& execution) {
  const int32_t n = analysis.metric->vertex_count();
  std::vector<int32_t> all(n);
  for (int32_t v = 0; v < n; ++v) all[v] = v;
  RowMatrixf mean = RowMatrixf::Zero(n, votes.cols());
  analysis.metric->for_each_block(all, execution, [&](int64_t first, int32_t count, const float* distances) {
    float largest[lanes];
    largest_distances(distances, n, largest);
    int32_t near[lanes] = {};
    for (int64_t v = 0; v < n; ++v)
      for (int32_t j = 0; j < count; ++j)
        if (distances[v * lanes + j] < isoline_neighbourhood * largest[j])
          ++near[j], mean.row(first + j) += votes.row(v);
    for (int32_t j = 0; j < count; ++j) mean.row(first + j) /= static_cast<float>(std::max(near[j], 1));
  });
  return mean;
}

}  // namespace

RowMatrixf isoline_votes(const SurfaceAnalysis& analysis, const RowMatrixf& radii,
                         const Execution& execution) {
  return average_nearby(cast_isoline_votes(analysis, radii, execution), analysis, execution);
}

void largest_distances(const float* distances, int32_t n, float* largest) {
  std::fill_n(largest, lanes, 1e-30f);
  for (int64_t v = 0; v < n; ++v)
    for (int j = 0; j < lanes; ++j) largest[j] = std::max(largest[j], distances[v * lanes + j]);
}

}  // namespace focal
