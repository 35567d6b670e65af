// All eigenpairs of a dense symmetric matrix of a few hundred rows, threaded and in vectors.
#pragma once
#include "base/matrix.h"
#include "base/parallel.h"

namespace focal {

struct SymmetricEigen {
  Vector values;   // ascending
  Matrix vectors;  // columns, orthonormal: A vectors = vectors diag(values)
};

// The upper triangle of A is read. Throws not_converged when A is not finite.
SymmetricEigen symmetric_eigen(const Matrix& A, const Execution& execution);

// A B, by register tiles, shared out over threads. Sizes that are no multiple of 32 are filled up.
Matrix dense_product(const Matrix& A, const Matrix& B, const Execution& execution);

}  // namespace focal
