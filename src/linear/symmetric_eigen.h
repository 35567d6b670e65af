// All eigenpairs of a dense symmetric matrix of a few hundred rows, threaded and vectorised.
#pragma once
#include "base/matrix.h"
#include "base/parallel.h"

namespace focal {

struct SymmetricEigen {
  Vector values;   // ascending
  Matrix vectors;  // columns, orthonormal: A vectors = vectors diag(values)
};

// Only the upper triangle of A is read. Throws not_converged when A is not finite.
SymmetricEigen symmetric_eigen(const Matrix& A, const Execution& execution);

// A B, by register tiles, distributed over threads. Sizes that are not a multiple of 32 are padded.
Matrix dense_product(const Matrix& A, const Matrix& B, const Execution& execution);

}  // namespace focal
