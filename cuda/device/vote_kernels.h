// Bodies of the kernels of forest, votes and peaks; see kernels.h.
#pragma once
#include "device/kernels.h"

namespace focal {

// ---- Forest and votes (see forest/regression_forest.h, analysis/leaf_votes.cpp, vote/vote.cpp)

struct ForestTable {
  const int32_t *node_start, *leaf_start_start, *leaf_sample_start;
  const int32_t *feature, *child;
  const float* threshold;
  const int32_t *leaf_start, *leaf_sample;
  const uint16_t* target_bin;  // training samples x landmarks
  int32_t trees, landmarks, bins, half;
  const float *kernel, *decay;
};

// The number of the leaf; a NaN goes right, as on the CPU.
FOCAL_HOST_DEVICE inline int32_t leaf_of(const ForestTable& forest, int32_t tree, const float* descriptor) {
  const int32_t first = forest.node_start[tree];
  int32_t node = 0;
  while (forest.feature[first + node] >= 0)
    node = forest.child[first + node] +
           (descriptor[forest.feature[first + node]] <= forest.threshold[first + node] ? 0 : 1);
  return forest.child[first + node];
}

struct LeafEntry {  // samples x trees
  ForestTable forest;
  const float* descriptor;
  int32_t* leaf;
  int32_t components;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    leaf[at] =
        leaf_of(forest, static_cast<int32_t>(at % forest.trees), descriptor + at / forest.trees * components);
  }
};

struct TargetBin {  // training samples x landmarks
  const uint16_t* target;
  uint16_t* bin;
  float to_bin;
  int32_t bins;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int32_t found = static_cast<int32_t>(static_cast<float>(target[at]) * to_bin);
    bin[at] = static_cast<uint16_t>(target[at] == 65535 ? bins : found < bins - 1 ? found : bins - 1);
  }
};

// Histogram of one sample and landmark: samples x (bins + 1 + 2 half) x landmarks, zero before; the last of the bins, of
// what is missing, is emptied again.
struct HistogramColumn {
  ForestTable forest;
  const int32_t* leaf;
  float* histogram;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int32_t L = forest.landmarks;
    const int64_t sample = at / L, l = at % L;
    const int32_t rows = forest.bins + 1 + 2 * forest.half;
    float* all = histogram + sample * rows * L + l;
    for (int32_t r = 0; r < rows; ++r) all[static_cast<int64_t>(r) * L] = 0;
    float* bins = all + static_cast<int64_t>(forest.half) * L;
    for (int32_t t = 0; t < forest.trees; ++t) {
      const int32_t* start = forest.leaf_start + forest.leaf_start_start[t] + leaf[sample * forest.trees + t];
      const float weight =
          1.0f / static_cast<float>((start[1] - start[0]) * static_cast<int64_t>(forest.trees));
      for (int32_t i = start[0]; i < start[1]; ++i) {
        const int64_t of = forest.leaf_sample[forest.leaf_sample_start[t] + i];
        bins[static_cast<int64_t>(forest.target_bin[of * L + l]) * L] += weight;
      }
    }
    bins[static_cast<int64_t>(forest.bins) * L] = 0;
  }
};

// Smoothed histogram times decay: samples x (bins + 1) x landmarks.
struct TableEntry {
  ForestTable forest;
  const float* histogram;
  float* table;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t L = forest.landmarks, rows = forest.bins + 1;
    const int64_t sample = at / (rows * L), r = at / L % rows, l = at % L;
    const float* here = histogram + (sample * (rows + 2 * forest.half) + r + forest.half) * L + l;
    float sum = 0;
    for (int64_t i = 0; i < forest.half; ++i) sum += forest.kernel[i] * (here[-(i + 1) * L] + here[i * L]);
    table[at] = forest.decay[r] * sum;
  }
};

// votes(v, l) += table of sample j at its distance from v, over some samples in order.
struct VoteEntry {
  const float *table, *distance;  // distance: n x s
  float* votes;                   // n x landmarks
  float to_row;
  int32_t rows, landmarks, s, count;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t v = at / landmarks, l = at % landmarks;
    float sum = votes[at];
    for (int64_t j = 0; j < count; ++j) {
      const float place = distance[v * s + j] * to_row;
      const int32_t row = place < static_cast<float>(rows - 2) ? static_cast<int32_t>(place) : rows - 2;
      const float fraction = fminf(place - static_cast<float>(row), 1.0f);
      const float* low = table + (j * rows + row) * landmarks + l;
      sum += low[0] + fraction * (low[landmarks] - low[0]);
    }
    votes[at] = sum;
  }
};

// Puts a matrix into one with more columns, which are 0.
struct WidenEntry {
  const float* from;
  float* to;
  int32_t columns, stride;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t column = at % stride;
    to[at] = column < columns ? from[at / stride * columns + column] : 0;
  }
};

// ---- Preset paper (see paper/paper.cpp)

struct LargestDistance {  // from each source
  const float* distance;  // n x s
  float* largest;
  int32_t n, s;
  FOCAL_HOST_DEVICE void operator()(int64_t j) const {
    float most = 1e-30f;
    for (int64_t v = 0; v < n; ++v) most = fmaxf(most, distance[v * s + j]);
    largest[j] = most;
  }
};

struct ShareOfLargest {
  const float* largest;
  float* distance;
  int32_t s;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const { distance[at] /= largest[at % s]; }
};

// votes(v, k) += weight of sample j for each edge of v that its isoline at radius(j, k) crosses, over some samples in order.
struct IsolineEntry {
  const float* share;  // n x s: of the sample's largest distance
  const int32_t *neighbour_start, *neighbour;
  const float *radius, *weight;  // samples x columns
  float* votes;                  // n x columns
  int32_t columns, s;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t v = at / columns, k = at % columns;
    float sum = votes[at];
    for (int32_t e = neighbour_start[v]; e < neighbour_start[v + 1]; ++e)
      for (int64_t j = 0; j < s; ++j) {
        const float here = share[v * s + j], there = share[static_cast<int64_t>(neighbour[e]) * s + j];
        const float r = radius[j * columns + k];
        if (fminf(here, there) <= r && r <= fmaxf(here, there)) sum += weight[j * columns + k];
      }
    votes[at] = sum;
  }
};

// The mean vote over what lies nearer to a source than a share of its largest distance.
struct NearbyMean {
  const float *distance, *largest;  // n x s, s
  const float* votes;               // n x columns
  float* mean;                      // s x columns
  float share;
  int32_t n, columns, s;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t j = at / columns, k = at % columns;
    float sum = 0;
    int32_t near = 0;
    for (int64_t v = 0; v < n; ++v)
      if (distance[v * s + j] < share * largest[j]) sum += votes[v * columns + k], ++near;
    mean[at] = sum / static_cast<float>(near > 0 ? near : 1);
  }
};

// ---- Peaks (see vote/peaks.cpp)

// The first of the largest among a chunk of vertices; taken ones are -infinity.
struct BestInChunk {
  static constexpr int32_t length = 64;
  const float* left;  // n x landmarks
  float* best;        // chunks x landmarks
  int32_t* vertex;
  int32_t n, landmarks;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t chunk = at / landmarks, l = at % landmarks;
    int64_t found = chunk * length;
    for (int64_t v = found + 1; v < n && v < (chunk + 1) * length; ++v)
      if (left[v * landmarks + l] > left[found * landmarks + l]) found = v;
    best[at] = left[found * landmarks + l], vertex[at] = static_cast<int32_t>(found);
  }
};

// The best of all chunks becomes peak `number` of its landmark, -1 where nothing is left; the connected part of a ball round it
// is taken.
struct TakePeak {
  const float* best;
  const int32_t* vertex;
  SparseColumns L;
  const double* position;  // n x 3
  float* left;             // n x landmarks
  int32_t *mark, *open;  // landmarks x n each; mark: the last peak, counted from 1, whose ball has the vertex
  int32_t* peak;         // landmarks x peaks
  double radius;
  int32_t n, landmarks, chunks, peaks, number;

  FOCAL_HOST_DEVICE bool is_near(int32_t a, int32_t b) const {
    const double x = position[3 * a] - position[3 * b], y = position[3 * a + 1] - position[3 * b + 1],
                 z = position[3 * a + 2] - position[3 * b + 2];
    return sqrt(x * x + y * y + z * z) < radius;
  }
  FOCAL_HOST_DEVICE void operator()(int64_t l) const {
    int64_t found = l;
    for (int64_t at = l + landmarks; at < static_cast<int64_t>(chunks) * landmarks; at += landmarks)
      if (best[at] > best[found]) found = at;
    int32_t& to = peak[l * peaks + number];
    to = -1;
    if (best[found] == -INFINITY) return;
    int32_t *mine = open + l * n, *marks = mark + l * n;
    to = mine[0] = vertex[found], marks[to] = number + 1;
    for (int32_t i = 0, count = 1; i < count; ++i) {
      left[static_cast<int64_t>(mine[i]) * landmarks + l] = -INFINITY;
      for (int32_t e = L.start[mine[i]]; e < L.start[mine[i] + 1]; ++e)
        if (const int32_t v = L.row[e]; marks[v] != number + 1 && is_near(v, to))
          marks[v] = number + 1, mine[count++] = v;
    }
  }
};

}  // namespace focal
