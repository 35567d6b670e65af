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
// The tables of one block of samples: weight of a distance, interpolated between evenly spaced bin centres.
struct VoteTables {
  int32_t bins = 0, landmarks = 0;
  double bin_width = 0;       // distance a bin, same unit as the distances
  std::vector<float> weight;  // [sample][bin][landmark]
  const float* of(int64_t sample) const { return &weight[sample * bins * landmarks]; }
};

// votes(v, l) += tables of sample j at distances[v * 32 + j], for j < count. Rows are shared out over threads.
void add_distribution_votes(const VoteTables& tables, const float* distances, int32_t count,
                            RowMatrixf& votes, const Execution& execution);

// `paper` (Xia et al. 2016, Section 4.4): every edge crossed by the isoline of sample j at radius(j, l) gives
// exp(-mu radius^2) to both its ends. distances as above, radii: count x landmarks in the same unit; edges: e x 2.
void add_isoline_votes(const RowMatrixf& radii, const float* distances, int32_t count,
                       const Eigen::Matrix<int32_t, Eigen::Dynamic, 2, Eigen::RowMajor>& edges, double mu,
                       RowMatrixf& votes);

}  // namespace focal
