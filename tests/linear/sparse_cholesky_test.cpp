// Sparse Cholesky: blocked and single solves against dense algebra, and matrices that have no factor.
#include "linear/sparse_cholesky.h"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>
#include <vector>

#include "base/error.h"
#include "base/multiversion.h"
#include "base/random.h"

namespace focal {
namespace {

constexpr int lanes = SparseCholesky::lanes;

// Sparse, symmetric, diagonally dominant: positive definite. n is odd on purpose.
SparseMatrix random_definite(int32_t n) {
  Random random(7);
  std::vector<Eigen::Triplet<double>> entries;
  for (int32_t i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 4.1);
    for (int k = 0; k < 2; ++k) {
      const auto j = static_cast<int32_t>(random.below(n));
      const double value = random.uniform();
      for (const auto& [a, b, x] : {std::tuple{i, i, value}, {j, j, value}, {i, j, -value}, {j, i, -value}})
        entries.emplace_back(a, b, x);
    }
  }
  SparseMatrix A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

// Solves for the columns of B as one interleaved block.
template <class T>
Matrix solve_as_block(const SparseCholesky& cholesky, const Matrix& B) {
  std::vector<T> storage(cholesky.size() * lanes + 64 / sizeof(T));
  void* start = storage.data();
  size_t space = storage.size() * sizeof(T);
  T* X = static_cast<T*>(std::align(64, cholesky.size() * lanes * sizeof(T), start, space));
  const auto& permutation = cholesky.permutation();
  for (int32_t i = 0; i < cholesky.size(); ++i)
    for (int j = 0; j < lanes; ++j) X[permutation[i] * lanes + j] = static_cast<T>(B(i, j));
  cholesky.solve_block(X);
  Matrix out(B.rows(), B.cols());
  for (int32_t i = 0; i < cholesky.size(); ++i)
    for (int j = 0; j < lanes; ++j) out(i, j) = X[permutation[i] * lanes + j];
  return out;
}

Matrix random_sides(int32_t n) {
  Random random(3);
  return Matrix::NullaryExpr(n, lanes, [&] { return random.normal(); });
}

TEST_CASE("a block of sides is solved as by dense algebra, in double and in float") {
  const SparseMatrix A = random_definite(301);
  const SparseCholesky cholesky(A);
  const Matrix B = random_sides(301);
  const Matrix X = Matrix(A).llt().solve(B);
  CHECK((solve_as_block<double>(cholesky, B) - X).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((solve_as_block<float>(cholesky, B) - X).cwiseAbs().maxCoeff() < 1e-5);
}

TEST_CASE("wide supernodes, single columns and all instruction sets give the same") {
  // Dense up to unknown 67, then a chain: one wide supernode of odd width, and narrow ones.
  SparseMatrix A(90, 90);
  for (int i = 0; i < 67; ++i)
    for (int j = 0; j < 67; ++j) A.coeffRef(i, j) = i == j ? 80 : std::cos(i * 7 + j * 7);
  for (int i = 67; i < 90; ++i) A.coeffRef(i, i) = 3, A.coeffRef(i, i - 1) = A.coeffRef(i - 1, i) = -1;
  const SparseCholesky cholesky(A);
  const Matrix B = random_sides(90), X = Matrix(A).llt().solve(B);
  for (const auto set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    limit_instruction_set(set);
    CHECK((solve_as_block<double>(cholesky, B) - X).cwiseAbs().maxCoeff() < 1e-13);
    CHECK((solve_as_block<float>(cholesky, B) - X).cwiseAbs().maxCoeff() < 1e-5);
  }
  CHECK((cholesky.solve(B.col(5)) - X.col(5)).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("a single side gives the column of the block") {
  const SparseMatrix A = random_definite(301);
  const SparseCholesky cholesky(A);
  const Matrix B = random_sides(301);
  const Matrix X = solve_as_block<double>(cholesky, B);
  for (const int j : {0, 17, 31}) CHECK((cholesky.solve(B.col(j)) - X.col(j)).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("one unknown, and a diagonal matrix without any strict triangle") {
  SparseMatrix A(3, 3);
  A.setIdentity();
  A *= 4;
  CHECK(SparseCholesky(A).stored() == 3);
  CHECK(SparseCholesky(A).solve(Vector::Constant(3, 2))(1) == doctest::Approx(0.5));
  SparseMatrix one(1, 1);
  one.insert(0, 0) = 9;
  CHECK(SparseCholesky(one).solve(Vector::Constant(1, 18))(0) == doctest::Approx(2));
}

TEST_CASE("a matrix that is indefinite or not finite is refused") {
  for (const double bad :
       {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    SparseMatrix A = random_definite(20);
    A.coeffRef(11, 11) = bad;
    try {
      SparseCholesky cholesky(A);
      FAIL("accepted a diagonal entry of " << bad);
    } catch (const Error& error) {
      CHECK(error.status() == Status::not_converged);
      CHECK_FALSE(error.hint().empty());
    }
  }
}

}  // namespace
}  // namespace focal
