// Votes of the sample points for the positions of the landmarks. This stage uses only distances and tables,
// no forest.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/matrix.h"
#include "base/parallel.h"

namespace focal {

// `default`: a sample whose leaves contain a distribution of distances gives each vertex the weight at its
// own distance. The tables of some samples: weights at the evenly spaced distances 0, width, 2 width ...,
// interpolated linearly.
struct VoteTables {
  static constexpr int32_t pad = 8;  // the landmarks of a row are padded with zeros to a multiple of it
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

// votes(v, l) += table of sample j at its distance from v, for the samples of the first tables, which are
// those of `distances` from `first` (a multiple of 32) on. votes: vertices x stride(). Rows are distributed
// over threads.
void add_distribution_votes(const VoteTables& tables, int32_t count, const QuantisedDistances& distances,
                            int32_t first, RowMatrixf& votes, const Execution& execution);

// `paper` (Xia et al. 2016, Section 4.4): every edge crossed by the isoline of sample j at radius(j, l) adds
// exp(-mu radius^2) to both its ends. distances[v * 32 + j]: of vertex v from sample j; radii: count x
// landmarks in the same unit; edges: e x 2.
void add_isoline_votes(const RowMatrixf& radii, const float* distances, int32_t count, const Edges& edges,
                       double mu, RowMatrixf& votes);

}  // namespace focal
