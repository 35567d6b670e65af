// Eigenpairs of dense symmetric matrices, easy and nasty ones, and the product.
#include "linear/symmetric_eigen.h"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <limits>

#include "base/error.h"
#include "base/random.h"

using namespace focal;

namespace {

Matrix random_dense(Eigen::Index rows, Eigen::Index columns, uint64_t seed) {
  Random random(seed);
  return Matrix::NullaryExpr(rows, columns, [&] { return random.normal(); });
}

void check(const Matrix& A) {
  const Eigen::Index n = A.rows();
  const SymmetricEigen eigen = symmetric_eigen(A, {});
  const double size = std::max(A.cwiseAbs().maxCoeff(), 1e-300) * static_cast<double>(n);
  CHECK(std::is_sorted(eigen.values.begin(), eigen.values.end()));
  CHECK((A * eigen.vectors - eigen.vectors * eigen.values.asDiagonal()).cwiseAbs().maxCoeff() < 1e-14 * size);
  CHECK((eigen.vectors.transpose() * eigen.vectors - Matrix::Identity(n, n)).cwiseAbs().maxCoeff() < 1e-13);
  const Vector peer = Eigen::SelfAdjointEigenSolver<Matrix>(A).eigenvalues();
  CHECK((eigen.values - peer).cwiseAbs().maxCoeff() < 1e-14 * size);
}

}  // namespace

TEST_CASE("random symmetric matrices of any size") {
  for (const int n : {1, 2, 3, 31, 32, 65, 192}) {
    const Matrix X = random_dense(n, n, n);
    check(X + X.transpose());
  }
}

TEST_CASE("repeated, zero, graded and nearly diagonal eigenvalues") {
  check(Matrix::Zero(40, 40));
  check(Matrix::Identity(40, 40));
  const Matrix Q = Eigen::HouseholderQR<Matrix>(random_dense(60, 60, 5)).householderQ();
  Vector values(60);
  for (int i = 0; i < 60; ++i) values[i] = i / 20;  // three values, twenty times each
  check(Q * values.asDiagonal() * Q.transpose());
  for (int i = 0; i < 60; ++i) values[i] = std::pow(0.5, i);
  check(Q * values.asDiagonal() * Q.transpose());
  const Matrix X = random_dense(60, 60, 6);
  check(Matrix(Vector::LinSpaced(60, 1, 1000).asDiagonal()) + 1e-6 * (X + X.transpose()));
  check(1e-200 * (X + X.transpose()));
}

TEST_CASE("only the upper triangle counts, threads do not change a bit, what is not finite is refused") {
  Matrix A = random_dense(70, 70, 7);
  A = (A + A.transpose()).eval();
  const SymmetricEigen one = symmetric_eigen(A, Execution().inner());
  Execution four;
  four.thread_count = 4;
  CHECK(symmetric_eigen(A, four).vectors == one.vectors);
  Matrix upper = A;
  upper.triangularView<Eigen::StrictlyLower>().setConstant(9);
  CHECK(symmetric_eigen(upper, {}).values == one.values);
  A(3, 50) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(symmetric_eigen(A, {}), Error);
}

TEST_CASE("products of any size") {
  for (const int n : {1, 5, 33, 64}) {
    const Matrix A = random_dense(n, n + 3, 1), B = random_dense(n + 3, 2 * n, 2);
    CHECK((dense_product(A, B, {}) - A * B).cwiseAbs().maxCoeff() < 1e-13 * (n + 3));
  }
}
