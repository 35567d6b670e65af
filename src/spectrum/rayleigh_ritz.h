// The dense half of subspace iteration: the best eigenpairs within the span of a few hundred tall columns.
#pragma once
#include "base/aligned_array.h"
#include "base/parallel.h"
#include "linear/sparse_cholesky.h"

namespace focal {

// n x count() numbers in blocks of 32 interleaved columns (see SparseCholesky), one block after the other.
struct Columns {
  static constexpr int lanes = SparseCholesky::lanes;
  int64_t n, stride;  // rows; stored rows, a multiple of 4 (the kernels' step), padded with 0
  int blocks;
  AlignedArray<double> data;

  Columns(int64_t rows, int block_count);
  double* block(int b) const { return data.data() + b * stride * lanes; }
  int count() const { return blocks * lanes; }
  double operator()(int64_t i, int j) const { return block(j / lanes)[i * lanes + j % lanes]; }
};

// Makes X orthonormal to float precision.
void orthonormalise_roughly(const Columns& X, const Execution& execution);

// Replaces X by approximate eigenvectors of the symmetric A, orthonormal; returns their eigenvalues,
// ascending. Leading blocks that have completely converged are not changed: `locked` are their eigenvalues.
Vector rayleigh_ritz(const SparseMatrix& A, const Columns& X, const Vector& locked,
                     const Execution& execution);
// The same with float sums, in half the time, for columns that are filtered again.
Vector rough_rayleigh_ritz(const SparseMatrix& A, const Columns& X, const Execution& execution);

// |A x - lambda x| of each column.
Vector residual_norms(const SparseMatrix& A, const Columns& X, const Vector& lambda,
                      const Execution& execution);

}  // namespace focal
