// Votes of the sample points for where a landmark lies, and the places with most of them. This stage sees distances and
// tables only, never a forest.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/matrix.h"
#include "base/parallel.h"

namespace focal {

// `default`: a sample whose leaves hold a distribution of distances gives each vertex the weight of its own distance.
// The tables of some samples: weight at evenly spaced distances 0, width, 2 width ..., interpolated between.
struct VoteTables {
  static constexpr int32_t pad = 8;  // landmarks of a row are filled up to a multiple of it with zeros
  int32_t rows = 0, landmarks = 0;
  double width = 0;           // distance from row to row, same unit as the distances
  std::vector<float> weight;  // [sample][row][padded landmark]
  static int32_t padded(int32_t landmarks) { return (landmarks + pad - 1) / pad * pad; }
  int32_t stride() const { return padded(landmarks); }
  float* of(int64_t sample) { return &weight[sample * rows * stride()]; }
  const float* of(int64_t sample) const { return &weight[sample * rows * stride()]; }
};

// Distances as 16-bit numbers of `step`: [block of 32 samples][vertex][sample].
struct QuantisedDistances {
  const uint16_t* steps = nullptr;
  double step = 0;
  int32_t vertices = 0;
};

// votes(v, l) += table of sample j at its distance from v, for the first tables' samples, which are those of `distances`
// from `first` (a multiple of 32) on. votes: vertices x stride(). Rows are shared out over threads.
void add_distribution_votes(const VoteTables& tables, int32_t count, const QuantisedDistances& distances,
                            int32_t first, RowMatrixf& votes, const Execution& execution);

// `paper` (Xia et al. 2016, Section 4.4): every edge crossed by the isoline of sample j at radius(j, l) gives
// exp(-mu radius^2) to both its ends. distances[v * 32 + j] of vertex v from sample j; radii: count x landmarks in the same unit; edges: e x 2.
void add_isoline_votes(const RowMatrixf& radii, const float* distances, int32_t count, const Edges& edges,
                       double mu, RowMatrixf& votes);

}  // namespace focal
