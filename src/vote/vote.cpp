#include "vote/vote.h"

#include <algorithm>
#include <cmath>

#include "base/multiversion.h"

namespace focal {
namespace {

constexpr int lanes = 32;

FOCAL_MULTIVERSION(void add_interpolated(float* votes, const float* low, const float* high, float fraction,
                                         int32_t count),
                   for (int32_t l = 0; l < count; ++l) votes[l] += low[l] + fraction * (high[l] - low[l]);)

}  // namespace

void add_distribution_votes(const VoteTables& tables, const float* distances, int32_t count,
                            RowMatrixf& votes, const Execution& execution) {
  const auto inverse_width = static_cast<float>(1 / tables.bin_width);
  const auto last = static_cast<float>(tables.bins - 1);
  parallel_for_ranges(execution, votes.rows(), 512, [&](int64_t begin, int64_t end) {
    for (int64_t v = begin; v < end; ++v)
      for (int32_t j = 0; j < count; ++j) {
        const float at = std::clamp(distances[v * lanes + j] * inverse_width - 0.5f, 0.0f, last);
        const auto bin = std::min(static_cast<int32_t>(at), tables.bins - 2);
        const float* low = tables.of(j) + static_cast<int64_t>(bin) * tables.landmarks;
        add_interpolated(&votes(v, 0), low, low + tables.landmarks, at - static_cast<float>(bin),
                         tables.landmarks);
      }
  });
}

void add_isoline_votes(const RowMatrixf& radii, const float* distances, int32_t count,
                       const Eigen::Matrix<int32_t, Eigen::Dynamic, 2, Eigen::RowMajor>& edges, double mu,
                       RowMatrixf& votes) {
  const RowMatrixf weights = (-static_cast<float>(mu) * radii.array().square()).exp();
  // The radii of a sample in ascending order: an edge crosses those between its two distances.
  std::vector<std::vector<std::pair<float, int32_t>>> sorted(count);
  for (int32_t j = 0; j < count; ++j) {
    for (int32_t l = 0; l < radii.cols(); ++l) sorted[j].emplace_back(radii(j, l), l);
    std::sort(sorted[j].begin(), sorted[j].end());
  }
  for (Eigen::Index e = 0; e < edges.rows(); ++e) {
    const int64_t a = edges(e, 0), b = edges(e, 1);
    for (int32_t j = 0; j < count; ++j) {
      const auto [low, high] = std::minmax(distances[a * lanes + j], distances[b * lanes + j]);
      for (auto it = std::lower_bound(sorted[j].begin(), sorted[j].end(), std::pair{low, INT32_MIN});
           it != sorted[j].end() && it->first <= high; ++it) {
        votes(a, it->second) += weights(j, it->second);
        votes(b, it->second) += weights(j, it->second);
      }
    }
  }
}

}  // namespace focal
