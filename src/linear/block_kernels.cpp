// Register-tiled products of blocks of 32 columns.
#include "linear/block_kernels.h"

#include <algorithm>

#include "base/multiversion.h"

namespace focal {
namespace {

constexpr int lanes = 32;

// Four rows by four vectors of C stay in registers during the inner loop (two rows where registers are few).
template <int vector_bytes, class T>
FOCAL_INLINE void multiply_add_body(const StridedView<T>& A, int64_t rows, int64_t inner, const T* B, T* C) {
  typedef T Lane __attribute__((vector_size(vector_bytes), may_alias));
  constexpr int height = vector_bytes == 64 ? 4 : 2;
  constexpr int vectors = std::min<int>(4, lanes * sizeof(T) / vector_bytes);
  constexpr int width = vectors * vector_bytes / int{sizeof(T)};
  for (int lane = 0; lane < lanes; lane += width) {
    for (int64_t r = 0; r < rows; r += height) {
      const auto c = [&](int h) { return reinterpret_cast<Lane*>(C + (r + h) * lanes + lane); };
      Lane sum[height][vectors];
      for (int h = 0; h < height; ++h)
        for (int v = 0; v < vectors; ++v) sum[h][v] = c(h)[v];
      const T* a = A.data + r * A.row_step;
      for (int64_t l = 0; l < inner; ++l, a += A.inner_step) {
        const Lane* b = reinterpret_cast<const Lane*>(B + l * lanes + lane);
        for (int h = 0; h < height; ++h)
          for (int v = 0; v < vectors; ++v) sum[h][v] += a[h * A.row_step] * b[v];
      }
      for (int h = 0; h < height; ++h)
        for (int v = 0; v < vectors; ++v) c(h)[v] = sum[h][v];
    }
  }
}

template <int vector_bytes>
FOCAL_INLINE void multiply_rows_body(const SparseMatrix& A, int64_t begin, int64_t end, const double* X,
                                     double* Y) {
  typedef double Lane __attribute__((vector_size(vector_bytes), may_alias));
  constexpr int vectors = 4, width = vectors * vector_bytes / int{sizeof(double)};
  const auto *start = A.outerIndexPtr(), *index = A.innerIndexPtr();
  const double* value = A.valuePtr();
  for (int64_t i = begin; i < end; ++i) {
    for (int lane = 0; lane < lanes; lane += width) {
      Lane sum[vectors] = {};
      for (auto p = start[i]; p < start[i + 1]; ++p) {
        const Lane* x = reinterpret_cast<const Lane*>(X + int64_t{index[p]} * lanes + lane);
        for (int v = 0; v < vectors; ++v) sum[v] += value[p] * x[v];
      }
      for (int v = 0; v < vectors; ++v) reinterpret_cast<Lane*>(Y + (i - begin) * lanes + lane)[v] = sum[v];
    }
  }
}

FOCAL_MULTIVERSION(void multiply_add_lanes(const StridedView<double>& A, int64_t rows, int64_t inner,
                                           const double* B, double* C),
                   multiply_add_body<vector_bytes>(A, rows, inner, B, C);)
FOCAL_MULTIVERSION(void multiply_add_lanes(const StridedView<float>& A, int64_t rows, int64_t inner,
                                           const float* B, float* C),
                   multiply_add_body<vector_bytes>(A, rows, inner, B, C);)
FOCAL_MULTIVERSION(void multiply_rows_lanes(const SparseMatrix& A, int64_t begin, int64_t end,
                                            const double* X, double* Y),
                   multiply_rows_body<vector_bytes>(A, begin, end, X, Y);)

}  // namespace

void multiply_add(const StridedView<double>& A, int64_t rows, int64_t inner, const double* B, double* C) {
  multiply_add_lanes(A, rows, inner, B, C);
}

void multiply_add(const StridedView<float>& A, int64_t rows, int64_t inner, const float* B, float* C) {
  multiply_add_lanes(A, rows, inner, B, C);
}

void multiply_rows(const SparseMatrix& A, int64_t begin, int64_t end, const double* X, double* Y) {
  multiply_rows_lanes(A, begin, end, X, Y);
}

}  // namespace focal
