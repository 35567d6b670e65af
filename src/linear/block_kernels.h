// Dense and sparse products of tall blocks of 32 interleaved columns (those of SparseCholesky): X[i * 32 + j]
// is row i of column j. Each sum is in the order of its inner index, so the bits do not depend on the
// processor.
#pragma once
#include <cstdint>

#include "base/matrix.h"

namespace focal {

// A strided view: entry (r, l) is at data[r * row_step + l * inner_step].
template <class T>
struct StridedView {
  const T* data;
  int64_t row_step, inner_step;
};

// C += A B: A is rows x inner, B inner x 32, C rows x 32; rows a multiple of 4, B and C 64-byte aligned.
void multiply_add(const StridedView<double>& A, int64_t rows, int64_t inner, const double* B, double* C);
void multiply_add(const StridedView<float>& A, int64_t rows, int64_t inner, const float* B, float* C);

// Rows [begin, end) of A X, stored from the start of Y. A is symmetric, so its columns are its rows.
void multiply_rows(const SparseMatrix& A, int64_t begin, int64_t end, const double* X, double* Y);

}  // namespace focal
