// Votes of preset `paper` on the CPU: Xia et al. 2016, Sections 4.4 and 5.
#pragma once
#include "analysis/surface_analysis.h"

namespace focal {

inline constexpr double isoline_decay = 5;             // Section 5: weight factor
inline constexpr float isoline_neighbourhood = 0.02f;  // Section 5: radius over which votes are averaged

// Votes of the samples along isolines at radii (samples x columns, relative to a sample's largest distance),
// averaged over a neighbourhood of each vertex relative to its own largest distance: vertices x columns.
RowMatrixf isoline_votes(const SurfaceAnalysis& analysis, const RowMatrixf& radii,
                         const Execution& execution);

// The largest distance in each lane of a block of distances from n vertices.
void largest_distances(const float* distances, int32_t n, float* largest);

}  // namespace focal
