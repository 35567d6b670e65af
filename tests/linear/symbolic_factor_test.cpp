// The analysis of a pattern: what it says must hold for the factor that dense algebra gives.
#include "linear/symbolic_factor.h"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <vector>

#include "base/random.h"
#include "linear/sparse_cholesky.h"
#include "operators/operators.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

SparseMatrix definite(const TriangleMesh& mesh, double shift) {
  const Operators operators = make_operators(mesh);
  SparseMatrix A = operators.L;
  for (int32_t i = 0; i < A.rows(); ++i) A.coeffRef(i, i) += shift * operators.mass[i];
  return A;
}

TriangleMesh two_parts() {
  const TriangleMesh a = sphere(3), b = square(6, 0.2);
  TriangleMesh both{MatrixX3(a.vertex_count() + b.vertex_count(), 3),
                    MatrixX3i(a.triangle_count() + b.triangle_count(), 3)};
  both.positions << a.positions, b.positions;
  both.triangles << a.triangles, (b.triangles.array() + a.vertex_count()).matrix();
  return both;
}

void check_is_permutation(std::vector<int32_t> order) {
  std::sort(order.begin(), order.end());
  for (int32_t i = 0; i < static_cast<int32_t>(order.size()); ++i) REQUIRE(order[i] == i);
}

// Every entry of the dense factor that is not rounding lies in a panel.
void check_covers_factor(const SymbolicFactor& factor, const SparseMatrix& A) {
  check_is_permutation(factor.permutation);
  const int32_t n = factor.size();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int32_t> order(n);
  std::copy(factor.permutation.begin(), factor.permutation.end(), order.indices().data());
  SparseMatrix permuted;
  permuted = A.twistedBy(order);
  Matrix G = Matrix(permuted).llt().matrixL();
  REQUIRE(factor.first_column.back() == n);
  for (int32_t s = 0; s < factor.supernodes(); ++s) {
    const int32_t first = factor.first_column[s], width = factor.width(s);
    G.block(first, first, width, width).setZero();
    REQUIRE(std::is_sorted(factor.rows.begin() + factor.row_start[s],
                           factor.rows.begin() + factor.row_start[s + 1]));
    for (int64_t p = factor.row_start[s]; p < factor.row_start[s + 1]; ++p)
      G.block(factor.rows[p], first, 1, width).setZero();
  }
  CHECK(G.cwiseAbs().maxCoeff() < 1e-12);
}

}  // namespace

TEST_CASE("the panels hold the whole factor, in the order of minimum degree or any other") {
  for (const TriangleMesh& mesh : {with_radius(sphere(4), lump), two_parts()}) {
    const SparseMatrix A = definite(mesh, 1);
    check_covers_factor(analyse_pattern(A), A);
    const auto n = static_cast<int32_t>(A.rows());
    std::vector<int32_t> order(n);
    std::iota(order.begin(), order.end(), 0);
    check_covers_factor(analyse_pattern(A, order), A);
    Random random(5);
    check_covers_factor(analyse_pattern(A, sample_without_replacement(random, n, n)), A);
  }
}

TEST_CASE("minimum degree fills far less than the order as given") {
  const SparseMatrix A = definite(square(30, 0.2), 1);
  std::vector<int32_t> order(A.rows());
  std::iota(order.begin(), order.end(), 0);
  CHECK(2 * analyse_pattern(A).value_start.back() < analyse_pattern(A, order).value_start.back());
}

TEST_CASE("a shared analysis gives the bits of one's own") {
  const TriangleMesh mesh = two_parts();
  const SparseMatrix A = definite(mesh, 1), B = definite(mesh, 40);
  const SparseCholesky own(B), shared(B, SparseCholesky(A));
  Random random(6);
  const Vector b = Vector::NullaryExpr(A.rows(), [&] { return random.normal(); });
  CHECK(own.solve(b) == shared.solve(b));
  CHECK((B * shared.solve(b) - b).cwiseAbs().maxCoeff() < 1e-11);
}

TEST_CASE("a matrix with other entries than the analysed one is refused") {
  const SparseMatrix A = definite(sphere(2), 1);
  SparseMatrix diagonal = A;
  diagonal.setIdentity();
  CHECK(SparseCholesky(diagonal, SparseCholesky(A)).solve(Vector::Ones(A.rows())) == Vector::Ones(A.rows()));
  CHECK_THROWS(SparseCholesky(A, SparseCholesky(diagonal)));
  CHECK_THROWS(SparseCholesky(definite(sphere(3), 1), SparseCholesky(A)));
}
