// Products of 32-column blocks against dense algebra, at sizes that are no multiple of a cache chunk.
#include "linear/block_kernels.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "base/aligned_array.h"
#include "base/random.h"

using namespace focal;

namespace {

constexpr int lanes = 32;

AlignedArray<double> aligned_copy(const RowMatrix& X) {
  AlignedArray<double> data(X.size());
  std::copy_n(X.data(), X.size(), data.data());
  return data;
}

RowMatrix random_matrix(Eigen::Index rows, Eigen::Index columns, uint64_t seed) {
  Random random(seed);
  return RowMatrix::NullaryExpr(rows, columns, [&] { return random.normal(); });
}

}  // namespace

TEST_CASE("C += A B and C += A^T B") {
  const RowMatrix A = random_matrix(36, 19, 1), B = random_matrix(19, lanes, 2),
                  C = random_matrix(36, lanes, 3);
  const RowMatrix transposed = A.transpose();
  const auto b = aligned_copy(B);
  for (const StridedView<double>& view :
       {StridedView<double>{A.data(), 19, 1}, StridedView<double>{transposed.data(), 1, 36}}) {
    const auto c = aligned_copy(C);
    multiply_add(view, 36, 19, b.data(), c.data());
    const Eigen::Map<const RowMatrix> result(c.data(), 36, lanes);
    CHECK((result - (C + A * B)).cwiseAbs().maxCoeff() < 1e-13);
  }
}

TEST_CASE("rows of a sparse matrix times a block") {
  const int n = 50;
  Random random(4);
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < 120; ++k) {
    const int i = static_cast<int>(random.below(n)), j = static_cast<int>(random.below(n));
    const double value = random.normal();
    entries.emplace_back(i, j, value), entries.emplace_back(j, i, value);
  }
  SparseMatrix A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  const RowMatrix X = random_matrix(n, lanes, 5);
  const auto x = aligned_copy(X);
  const AlignedArray<double> y(30 * lanes);
  multiply_rows(A, 7, 37, x.data(), y.data());
  const Eigen::Map<const RowMatrix> result(y.data(), 30, lanes);
  CHECK((result - RowMatrix(A * X).middleRows(7, 30)).cwiseAbs().maxCoeff() < 1e-13);
}
