// meshoptimizer's edge collapse, compiled so that its failures can be caught.
#pragma once
#include <span>
#include <vector>

#include "base/matrix.h"

namespace focal {

// Returns the remaining triangles, three indices each, aiming for about `wanted` triangles. options: of
// meshopt_simplify.
std::vector<unsigned> collapse_edges(
    std::span<const unsigned> indices,
    const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>& positions, size_t wanted,
    unsigned options);

}  // namespace focal
