// An order of elimination by cutting the surface in halves (A. George, "Nested Dissection of a Regular Finite Element
// Mesh", 1973), by coordinates.
#pragma once
#include <cstdint>
#include <vector>

#include "base/matrix.h"

namespace focal {

// [old] = new: both halves of the vertices first, the ones between them last, and so on within the halves. Large meshes are
// factorised and solved faster than by minimum degree. A: n x n, symmetric pattern, both triangles; positions: n x 3.
// Deterministic; O(n log n).
std::vector<int32_t> nested_dissection(const SparseMatrix& A, const MatrixX3& positions);

}  // namespace focal
