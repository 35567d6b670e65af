// The Rayleigh-Ritz procedure (B. Parlett, "The Symmetric Eigenvalue Problem", 1980, chapter 11) in chunks of
// rows that stay in cache. Sums over rows are split into a fixed number of ranges, so the bits do not depend
// on the number of threads.
#include "spectrum/rayleigh_ritz.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "linear/block_kernels.h"

namespace focal {
namespace {

constexpr int lanes = Columns::lanes;
constexpr int64_t tile_size = lanes * lanes;
constexpr int64_t chunk_rows = 64, range_count = 8;

// Calls visit(range, begin, end) for chunks of rows, the ranges in parallel.
template <class Visit>
void for_each_chunk(const Columns& X, const Execution& execution, const Visit& visit) {
  const int64_t length = (X.n + range_count - 1) / range_count;
  parallel_for(execution, range_count, [&](int64_t range) {
    const int64_t range_end = std::min(X.n, (range + 1) * length);
    for (int64_t begin = range * length; begin < range_end; begin += chunk_rows) {
      execution.check_cancelled();
      visit(range, begin, std::min(range_end, begin + chunk_rows));
    }
  });
}

// The same with Y, these rows of A X, block after block of chunk_rows rows, from block `first` on.
template <class Visit>
void for_each_product(const SparseMatrix& A, const Columns& X, int first, const Execution& execution,
                      const Visit& visit) {
  for_each_chunk(X, execution, [&](int64_t range, int64_t begin, int64_t end) {
    const AlignedArray<double> Y(chunk_rows * X.count());
    for (int b = first; b < X.blocks; ++b)
      multiply_rows(A, begin, end, X.block(b), Y.data() + b * chunk_rows * lanes);
    visit(range, begin, end, Y.data());
  });
}

// A symmetric matrix as a sum over the ranges, each stored in tiles of 32 x 32, of which those with a <= b
// are set.
template <class T>
class TiledSum {
 public:
  TiledSum(int blocks, const Execution& execution)
      : blocks_(blocks), data_(range_count * blocks * blocks * tile_size) {
    parallel_for(execution, range_count,
                 [&](int64_t range) { std::fill_n(tile(range, 0, 0), blocks * blocks * tile_size, T{0}); });
  }
  T* tile(int64_t range, int a, int b) const {
    return data_.data() + ((range * blocks_ + a) * blocks_ + b) * tile_size;
  }
  Matrix total(const Execution& execution) const {
    using Tile = Eigen::Matrix<T, lanes, lanes, Eigen::RowMajor>;
    Matrix sum = Matrix::Zero(blocks_ * lanes, blocks_ * lanes);
    parallel_for(execution, blocks_, [&](int64_t row) {
      const auto a = static_cast<int>(row);
      for (int b = a; b < blocks_; ++b)
        for (int64_t range = 0; range < range_count; ++range)
          sum.block<lanes, lanes>(a * lanes, b * lanes) +=
              Eigen::Map<const Tile>(tile(range, a, b)).template cast<double>();
    });
    return sum.selfadjointView<Eigen::Upper>();
  }

 private:
  int blocks_;
  AlignedArray<T> data_;
};

// The upper tiles of U^T V from column block `first` on, accumulated over one chunk of rows, block after
// block of chunk_rows rows.
template <class T>
void add_products(const TiledSum<T>& sum, int64_t range, int first, int blocks, int64_t rows, const T* U,
                  const T* V) {
  constexpr int64_t step = chunk_rows * lanes;
  for (int a = 0; a < blocks; ++a)
    for (int b = std::max(a, first); b < blocks; ++b)
      multiply_add(StridedView<T>{U + a * step, 1, lanes}, lanes, rows, V + b * step, sum.tile(range, a, b));
}

template <class T>
struct Rows {  // of all columns, copied to be contiguous
  AlignedArray<T> data;
  explicit Rows(const Columns& X) : data(chunk_rows * X.count()) {}
  void take(const double* from, int b, int64_t rows) {
    std::copy_n(from, rows * lanes, data.data() + b * chunk_rows * lanes);
  }
};

// X^T X, where the leading blocks up to `first` are known to be orthonormal.
template <class T>
Matrix gram_matrix(const Columns& X, int first, const Execution& execution) {
  const TiledSum<T> sum(X.blocks, execution);
  for_each_chunk(X, execution, [&](int64_t range, int64_t begin, int64_t end) {
    Rows<T> x(X);
    for (int b = 0; b < X.blocks; ++b) x.take(X.block(b) + begin * lanes, b, end - begin);
    add_products(sum, range, first, X.blocks, end - begin, x.data.data(), x.data.data());
  });
  Matrix gram = sum.total(execution);
  gram.topLeftCorner(first * lanes, first * lanes).setIdentity();
  return gram;
}

// X^T A X, where the leading blocks are known to be eigenvectors with the eigenvalues `locked`.
template <class T>
Matrix projection(const SparseMatrix& A, const Columns& X, const Vector& locked, const Execution& execution) {
  const int first = static_cast<int>(locked.size()) / lanes;
  const TiledSum<T> sum(X.blocks, execution);
  for_each_product(A, X, first, execution, [&](int64_t range, int64_t begin, int64_t end, const double* Y) {
    Rows<T> x(X), y(X);
    for (int b = 0; b < X.blocks; ++b) {
      x.take(X.block(b) + begin * lanes, b, end - begin);
      if (b >= first) y.take(Y + b * chunk_rows * lanes, b, end - begin);
    }
    add_products(sum, range, first, X.blocks, end - begin, x.data.data(), y.data.data());
  });
  Matrix projected = sum.total(execution);
  projected.topLeftCorner(locked.size(), locked.size()) = locked.asDiagonal();
  return projected;
}

// X <- X C; the leading blocks up to `first` are not changed.
template <class T>
void rotate(const Columns& X, const Matrix& C, int first, const Execution& execution) {
  const int64_t p = X.count();
  const AlignedArray<T> panels(p * p);           // C by blocks of columns, each row-major
  std::vector<std::vector<int>> used(X.blocks);  // where C is not 0: half of it when it is triangular
  for (int b = 0; b < X.blocks; ++b)
    for (int a = 0; a < X.blocks; ++a)
      if (!C.block<lanes, lanes>(a * lanes, b * lanes).isZero(0)) used[b].push_back(a);
  for (int b = 0; b < X.blocks; ++b)
    for (int64_t i = 0; i < p; ++i)
      for (int j = 0; j < lanes; ++j)
        panels.data()[(b * p + i) * lanes + j] = static_cast<T>(C(i, b * lanes + j));
  parallel_for_ranges(execution, X.stride, chunk_rows, [&](int64_t begin, int64_t end) {
    const int64_t rows = end - begin;
    const AlignedArray<T> given(rows * p), rotated(rows * lanes);
    for (int b = 0; b < X.blocks; ++b)
      std::copy_n(X.block(b) + begin * lanes, rows * lanes, given.data() + b * rows * lanes);
    for (int b = first; b < X.blocks; ++b) {
      std::fill_n(rotated.data(), rotated.size(), T{0});
      for (const int a : used[b])
        multiply_add(StridedView<T>{given.data() + a * rows * lanes, lanes, 1}, rows, lanes,
                     panels.data() + (b * p + a * lanes) * lanes, rotated.data());
      std::copy_n(rotated.data(), rows * lanes, X.block(b) + begin * lanes);
    }
  });
}

// C with (X C)^T (X C) = I, by the Cholesky factor of the Gram matrix of X. Where columns are numerically
// dependent that factor does not exist; then by eigenvectors, which leave the dependent directions short, and `complete`
// is false.
struct Orthonormaliser {
  Matrix C;
  bool complete;
};

using DenseEigen = Eigen::SelfAdjointEigenSolver<Matrix>;

DenseEigen dense_eigen(const Matrix& A) {
  DenseEigen eigen(A);
  if (!A.allFinite() || eigen.info() != Eigen::Success)
    throw Error(Status::not_converged, "the eigenvalues of the surface did not converge",
                "the mesh may hold non-finite positions or degenerate triangles; repair it first");
  return eigen;
}

Orthonormaliser orthonormaliser(const Matrix& gram, bool of_floats) {
  const Vector unit = gram.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
  const Matrix G = unit.asDiagonal() * gram * unit.asDiagonal();
  const Eigen::LLT<Matrix> llt(G);
  if (llt.info() == Eigen::Success && llt.matrixLLT().diagonal().minCoeff() > (of_floats ? 1e-3 : 1e-7))
    return {unit.asDiagonal() * Matrix(llt.matrixU().solve(Matrix::Identity(G.rows(), G.cols()))), true};
  const DenseEigen eigen = dense_eigen(G);
  const double shortest = (of_floats ? 1e-6 : 1e-12) * eigen.eigenvalues().maxCoeff();
  const Vector length = eigen.eigenvalues().cwiseMax(shortest).cwiseSqrt();
  return {unit.asDiagonal() * eigen.eigenvectors() * length.cwiseInverse().asDiagonal(), false};
}

// Returns the C that makes X C orthonormal. First rescales directions that rounding has left short.
template <class T>
Matrix prepare_orthonormal(const Columns& X, const Execution& execution) {
  for (int attempt = 0;; ++attempt) {
    const auto [C, complete] = orthonormaliser(gram_matrix<T>(X, 0, execution), std::is_same_v<T, float>);
    if (complete || attempt == 3) return C;
    rotate<T>(X, C, 0, execution);
  }
}

template <class T>
Vector solve_all(const SparseMatrix& A, const Columns& X, const Execution& execution) {
  const Matrix C = prepare_orthonormal<T>(X, execution);
  const Matrix projected = projection<T>(A, X, {}, execution);
  const DenseEigen eigen = dense_eigen(C.transpose() * projected * C);
  rotate<T>(X, C * eigen.eigenvectors(), 0, execution);
  return eigen.eigenvalues();
}

// Orthogonalises the columns after the locked ones against these, and solves the problem among them.
Vector solve_rest(const SparseMatrix& A, const Columns& X, const Vector& locked, const Execution& execution) {
  const int first = static_cast<int>(locked.size()) / lanes;
  const auto [C, complete] = orthonormaliser(gram_matrix<double>(X, first, execution), false);
  if (!complete) return solve_all<double>(A, X, execution);
  Matrix rest = C.rightCols(X.count() - locked.size());
  const Matrix projected = projection<double>(A, X, locked, execution);
  const DenseEigen eigen = dense_eigen(rest.transpose() * projected * rest);
  Matrix all = Matrix::Zero(X.count(), X.count());
  all.rightCols(rest.cols()) = rest * eigen.eigenvectors();
  rotate<double>(X, all, first, execution);
  Vector lambda(X.count());
  lambda << locked, eigen.eigenvalues();
  if (lambda(locked.size()) < locked(locked.size() - 1)) return solve_all<double>(A, X, execution);
  return lambda;
}

}  // namespace

Columns::Columns(int64_t rows, int block_count)
    : n(rows), stride((rows + 3) / 4 * 4), blocks(block_count), data(stride * block_count * lanes) {
  std::fill_n(data.data(), data.size(), 0.0);
}

void orthonormalise_roughly(const Columns& X, const Execution& execution) {
  rotate<float>(X, prepare_orthonormal<float>(X, execution), 0, execution);
}

Vector rough_rayleigh_ritz(const SparseMatrix& A, const Columns& X, const Execution& execution) {
  return solve_all<float>(A, X, execution);
}

Vector rayleigh_ritz(const SparseMatrix& A, const Columns& X, const Vector& locked,
                     const Execution& execution) {
  return locked.size() > 0 ? solve_rest(A, X, locked, execution) : solve_all<double>(A, X, execution);
}

Vector residual_norms(const SparseMatrix& A, const Columns& X, const Vector& lambda,
                      const Execution& execution) {
  RowMatrix squared = RowMatrix::Zero(range_count, X.count());
  for_each_product(A, X, 0, execution, [&](int64_t range, int64_t begin, int64_t end, const double* Y) {
    for (int b = 0; b < X.blocks; ++b) {
      const Eigen::Map<const RowMatrix> x(X.block(b) + begin * lanes, end - begin, lanes);
      const Eigen::Map<const RowMatrix> y(Y + b * chunk_rows * lanes, end - begin, lanes);
      const auto l = lambda.segment<lanes>(b * lanes).transpose().array();
      squared.row(range).segment<lanes>(b * lanes) +=
          (y.array() - x.array().rowwise() * l).square().colwise().sum().matrix();
    }
  });
  return squared.colwise().sum().cwiseSqrt().transpose();
}

}  // namespace focal
