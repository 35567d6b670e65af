// Joins borders that were meant to meet: exporters round coordinates, and artists leave gaps of a tenth of a
// millimetre.
#pragma once
#include <vector>

#include "mesh/edges.h"

namespace focal {

// For each vertex the first one nearer than the tolerance, or itself.
std::vector<int32_t> first_at_place(const MatrixX3& positions, double tolerance);

// For each vertex the one that represents it where open borders nearly meet: closer than 2e-4 of the box's
// diagonal, and than a quarter of every edge at the two, so that no edge degenerates. Empty where no borders
// nearly meet.
std::vector<int32_t> stitched_borders(const TriangleMesh& mesh, const EdgeSides& edges);

}  // namespace focal
