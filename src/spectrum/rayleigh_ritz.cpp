// The Rayleigh-Ritz procedure (B. Parlett, "The Symmetric Eigenvalue Problem", 1980, chapter 11) in chunks of
// rows that stay in cache. Sums over rows are split in a fixed number of ranges, so the bits do not depend on
// the threads.
#include "spectrum/rayleigh_ritz.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "linear/block_kernels.h"

namespace focal {
namespace {

constexpr int lanes = Columns::lanes;
constexpr int64_t tile_size = lanes * lanes;
constexpr int64_t chunk_rows = 64, range_count = 16;

// Calls visit(range, begin, end, Y) for chunks of rows; Y holds these rows of A X, block after block of
// chunk_rows rows.
template <class Visit>
void for_each_product(const SparseMatrix& A, const Columns& X, const Execution& execution,
                      const Visit& visit) {
  const int64_t length = (X.n + range_count - 1) / range_count;
  parallel_for(execution, range_count, [&](int64_t range) {
    const AlignedArray<double> Y(chunk_rows * X.count());
    const int64_t range_end = std::min(X.n, (range + 1) * length);
    for (int64_t begin = range * length; begin < range_end; begin += chunk_rows) {
      execution.check_cancelled();
      const int64_t end = std::min(range_end, begin + chunk_rows);
      for (int b = 0; b < X.blocks; ++b)
        multiply_rows(A, begin, end, X.block(b), Y.data() + b * chunk_rows * lanes);
      visit(range, begin, end, Y.data());
    }
  });
}

// A symmetric matrix as a sum over the ranges, each kept in tiles of 32 x 32, of which those with a <= b are
// filled.
class TiledSum {
 public:
  explicit TiledSum(int blocks) : blocks_(blocks), data_(range_count * blocks * blocks * tile_size) {
    std::fill_n(data_.data(), data_.size(), 0.0);
  }
  double* tile(int64_t range, int a, int b) const {
    return data_.data() + ((range * blocks_ + a) * blocks_ + b) * tile_size;
  }
  Matrix total() const {
    Matrix sum = Matrix::Zero(blocks_ * lanes, blocks_ * lanes);
    for (int64_t range = 0; range < range_count; ++range)
      for (int a = 0; a < blocks_; ++a)
        for (int b = a; b < blocks_; ++b)
          sum.block<lanes, lanes>(a * lanes, b * lanes) +=
              Eigen::Map<const Eigen::Matrix<double, lanes, lanes, Eigen::RowMajor>>(tile(range, a, b));
    return sum.selfadjointView<Eigen::Upper>();
  }

 private:
  int blocks_;
  AlignedArray<double> data_;
};

struct Projection {
  Matrix gram, projected;  // X^T X and X^T A X
};

Projection project(const SparseMatrix& A, const Columns& X, const Execution& execution) {
  const TiledSum gram(X.blocks), projected(X.blocks);
  for_each_product(A, X, execution, [&](int64_t range, int64_t begin, int64_t end, const double* Y) {
    for (int a = 0; a < X.blocks; ++a) {
      const StridedView transposed{X.block(a) + begin * lanes, 1, lanes};
      for (int b = a; b < X.blocks; ++b) {
        multiply_add(transposed, lanes, end - begin, X.block(b) + begin * lanes, gram.tile(range, a, b));
        multiply_add(transposed, lanes, end - begin, Y + b * chunk_rows * lanes, projected.tile(range, a, b));
      }
    }
  });
  return {gram.total(), projected.total()};
}

// X <- X C.
void rotate(const Columns& X, const Matrix& C, const Execution& execution) {
  const int64_t p = X.count();
  const AlignedArray<double> panels(p * p);  // C by blocks of columns, each row-major
  for (int b = 0; b < X.blocks; ++b)
    Eigen::Map<RowMatrix>(panels.data() + b * p * lanes, p, lanes) = C.middleCols(b * lanes, lanes);
  parallel_for_ranges(execution, X.stride, chunk_rows, [&](int64_t begin, int64_t end) {
    const AlignedArray<double> rotated((end - begin) * p);
    std::fill_n(rotated.data(), rotated.size(), 0.0);
    const auto target = [&](int b) { return rotated.data() + b * (end - begin) * lanes; };
    for (int b = 0; b < X.blocks; ++b)
      for (int a = 0; a < X.blocks; ++a)
        multiply_add({X.block(a) + begin * lanes, lanes, 1}, end - begin, lanes,
                     panels.data() + (b * p + a * lanes) * lanes, target(b));
    for (int b = 0; b < X.blocks; ++b)
      std::copy_n(target(b), (end - begin) * lanes, X.block(b) + begin * lanes);
  });
}

// C with (X C)^T (X C) = I, by the Cholesky factor of the Gram matrix of X. Where columns are dependent to
// rounding there is none: then by eigenvectors, which leave the dependent directions short, and `complete` is
// false.
struct Orthonormaliser {
  Matrix C;
  bool complete;
};

Orthonormaliser orthonormaliser(const Matrix& gram) {
  const Vector unit = gram.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
  const Matrix G = unit.asDiagonal() * gram * unit.asDiagonal();
  const Eigen::LLT<Matrix> llt(G);
  if (llt.info() == Eigen::Success && llt.matrixLLT().diagonal().minCoeff() > 1e-7)
    return {unit.asDiagonal() * Matrix(llt.matrixU().solve(Matrix::Identity(G.rows(), G.cols()))), true};
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(G);
  const Vector length = eigen.eigenvalues().cwiseMax(1e-12 * eigen.eigenvalues().maxCoeff()).cwiseSqrt();
  return {unit.asDiagonal() * eigen.eigenvectors() * length.cwiseInverse().asDiagonal(), false};
}

}  // namespace

Columns::Columns(int64_t rows, int block_count)
    : n(rows), stride((rows + 3) / 4 * 4), blocks(block_count), data(stride * block_count * lanes) {
  std::fill_n(data.data(), data.size(), 0.0);
}

Vector rayleigh_ritz(const SparseMatrix& A, const Columns& X, const Execution& execution) {
  for (int attempt = 0;; ++attempt) {
    const auto [gram, projected] = project(A, X, execution);
    const auto [C, complete] = orthonormaliser(gram);
    if (!complete && attempt < 3) {  // short directions get their full length in the next attempt
      rotate(X, C, execution);
      continue;
    }
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(C.transpose() * projected * C);
    rotate(X, C * eigen.eigenvectors(), execution);
    return eigen.eigenvalues();
  }
}

Vector residual_norms(const SparseMatrix& A, const Columns& X, const Vector& lambda,
                      const Execution& execution) {
  RowMatrix squared = RowMatrix::Zero(range_count, X.count());
  for_each_product(A, X, execution, [&](int64_t range, int64_t begin, int64_t end, const double* Y) {
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
