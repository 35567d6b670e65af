// Borders of parts that were made to meet and do not quite: exporters round, and artists leave a tenth of a millimetre.
#pragma once
#include <vector>

#include "mesh/edges.h"

namespace focal {

// Per vertex the first one that is nearer than the tolerance, itself where there is none.
std::vector<int32_t> first_at_place(const MatrixX3& positions, double tolerance);

// Per vertex the one that stands for it where open borders nearly meet: nearer than 2e-4 of the box's diagonal, and than a quarter of
// every edge at the two, so that no edge shrinks to nothing. Empty where no borders do.
std::vector<int32_t> stitched_borders(const TriangleMesh& mesh, const EdgeSides& edges);

}  // namespace focal
