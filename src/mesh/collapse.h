// meshoptimizer's edge collapse, where a failure may be caught.
#pragma once
#include <span>
#include <vector>

#include "base/matrix.h"

namespace focal {

// The triangles that are left, three numbers each, when about `wanted` triangles are to be. options: of meshopt_simplify.
std::vector<unsigned> collapse_edges(
    std::span<const unsigned> indices,
    const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>& positions, size_t wanted,
    unsigned options);

}  // namespace focal
