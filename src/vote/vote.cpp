#include "vote/vote.h"

#include <algorithm>
#include <cmath>

#include "base/multiversion.h"

namespace focal {
namespace {

constexpr int block_lanes = 32;

constexpr int32_t tile = 8;  // samples at a time: their tables fit in the level 2 cache

// One tile of samples over one range of vertices.
struct TileVotes {
  const float* table[tile];
  const uint16_t* steps;  // of the range's first vertex, the tile's first sample
  float to_row;           // rows per step
  int32_t count, last_row, stride;
  float* votes;
  int64_t vertices;
};

// Eight landmarks per vector; `vectors` vectors stay in registers during the samples of the tile.
template <int vectors>
FOCAL_INLINE void add_tile(const TileVotes& t, int32_t lane) {
  typedef float Lane __attribute__((vector_size(32), may_alias, aligned(4)));
  for (int64_t v = 0; v < t.vertices; ++v) {
    Lane* out = reinterpret_cast<Lane*>(t.votes + v * t.stride + lane);
    Lane sum[vectors];
    for (int k = 0; k < vectors; ++k) sum[k] = out[k];
    for (int32_t j = 0; j < t.count; ++j) {
      const float at = static_cast<float>(t.steps[v * block_lanes + j]) * t.to_row;
      const int32_t row = std::min(static_cast<int32_t>(at), t.last_row);
      const float fraction = std::min(at - static_cast<float>(row), 1.0f);
      const Lane* low = reinterpret_cast<const Lane*>(t.table[j] + int64_t{row} * t.stride + lane);
      const Lane* high = reinterpret_cast<const Lane*>(t.table[j] + int64_t{row + 1} * t.stride + lane);
      for (int k = 0; k < vectors; ++k) sum[k] += low[k] + fraction * (high[k] - low[k]);
    }
    for (int k = 0; k < vectors; ++k) out[k] = sum[k];
  }
}

FOCAL_INLINE void add_all_lanes(const TileVotes& t) {
  int32_t lane = 0;
  for (; lane + 32 <= t.stride; lane += 32) add_tile<4>(t, lane);
  for (; lane + 16 <= t.stride; lane += 16) add_tile<2>(t, lane);
  for (; lane < t.stride; lane += 8) add_tile<1>(t, lane);
}
FOCAL_MULTIVERSION(void add_lanes(const TileVotes& t), add_all_lanes(t);)

}  // namespace

void add_distribution_votes(const VoteTables& tables, int32_t count, const QuantisedDistances& distances,
                            int32_t first, RowMatrixf& votes, const Execution& execution) {
  parallel_for_ranges(execution, votes.rows(), 512, [&](int64_t begin, int64_t end) {
    for (int32_t from = 0; from < count; from += tile) {
      const int64_t sample = first + from;
      TileVotes t;
      t.count = std::min(tile, count - from);
      for (int32_t j = 0; j < t.count; ++j) t.table[j] = tables.of(from + j);
      t.steps = distances.steps + (sample / block_lanes * distances.vertices + begin) * block_lanes +
                sample % block_lanes;
      t.to_row = static_cast<float>(distances.step / tables.width);
      t.last_row = tables.rows - 2, t.stride = tables.stride();
      t.votes = &votes(begin, 0), t.vertices = end - begin;
      add_lanes(t);
    }
  });
}

void add_isoline_votes(const RowMatrixf& radii, const float* distances, int32_t count, const Edges& edges,
                       double mu, RowMatrixf& votes) {
  const RowMatrixf weights = (-static_cast<float>(mu) * radii.array().square()).exp();
  // The radii of a sample in ascending order: an edge is crossed by those between its two distances.
  std::vector<std::vector<std::pair<float, int32_t>>> sorted(count);
  for (int32_t j = 0; j < count; ++j) {
    for (int32_t l = 0; l < radii.cols(); ++l) sorted[j].emplace_back(radii(j, l), l);
    std::sort(sorted[j].begin(), sorted[j].end());
  }
  for (Eigen::Index e = 0; e < edges.rows(); ++e) {
    const int64_t a = edges(e, 0), b = edges(e, 1);
    for (int32_t j = 0; j < count; ++j) {
      const auto [low, high] = std::minmax(distances[a * block_lanes + j], distances[b * block_lanes + j]);
      for (auto it = std::lower_bound(sorted[j].begin(), sorted[j].end(), std::pair{low, INT32_MIN});
           it != sorted[j].end() && it->first <= high; ++it) {
        votes(a, it->second) += weights(j, it->second);
        votes(b, it->second) += weights(j, it->second);
      }
    }
  }
}

}  // namespace focal
