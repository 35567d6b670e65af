// The spectrum against formulas, its own definition, and one method against the other.
#include "spectrum/eigenbasis.h"

#include <doctest/doctest.h>

#include <thread>

#include "base/error.h"
#include "operators/operators.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

Eigenbasis solve(const Operators& operators, EigenMethod method, int32_t count, int threads = 1) {
  Execution execution;
  execution.thread_count = threads;
  return eigenbasis(operators.L, operators.mass, {count, method, 1e-8}, execution);
}

// Needles, as artists' meshes have: a lump squeezed to a tenth in one direction and stretched in another.
TriangleMesh squeezed_lump() {
  TriangleMesh mesh = with_radius(sphere(5), lump);
  mesh.positions.col(0) *= 0.1;
  mesh.positions.col(1) *= 5;
  return mesh;
}

void check_definition(const Operators& operators, const Eigenbasis& basis) {
  const Eigen::Index k = basis.lambda.size();
  const Matrix gram = basis.Phi.transpose() * operators.mass.asDiagonal() * basis.Phi;
  CHECK((gram - Matrix::Identity(k, k)).cwiseAbs().maxCoeff() < 1e-10);
  CHECK(basis.lambda(0) >= 0);
  CHECK(basis.lambda(0) < 1e-8 * basis.lambda(1));
  for (Eigen::Index j = 1; j < k; ++j) {
    CHECK(basis.lambda(j) >= basis.lambda(j - 1));
    const Vector residual =
        operators.L * basis.Phi.col(j) - basis.lambda(j) * operators.mass.cwiseProduct(basis.Phi.col(j));
    CHECK(residual.cwiseQuotient(operators.mass.cwiseSqrt()).norm() < 1e-7 * basis.lambda(j));
    CHECK(basis.Phi.col(j).maxCoeff() >= -basis.Phi.col(j).minCoeff());
  }
}

double largest_difference(const Vector& a, const Vector& b) {
  return ((a - b).array() / b.array().max(b(1))).abs().maxCoeff();
}

// Two equal parts: every eigenvalue is double.
TriangleMesh twins() {
  const TriangleMesh one = with_radius(sphere(4), lump);
  TriangleMesh both{MatrixX3(2 * one.vertex_count(), 3), MatrixX3i(2 * one.triangle_count(), 3)};
  both.positions << one.positions, one.positions.rowwise() + Eigen::RowVector3d(9, 0, 0);
  both.triangles << one.triangles, (one.triangles.array() + one.vertex_count()).matrix();
  return both;
}

}  // namespace

TEST_CASE("the unit sphere has eigenvalues l (l + 1), 2 l + 1 times each") {
  const Operators operators = make_operators(sphere(6));  // 16,386 vertices
  const Eigenbasis basis = solve(operators, EigenMethod::chebyshev, 49, 2);
  for (int l = 1, k = 1; l <= 6; ++l)
    for (int m = -l; m <= l; ++m, ++k) CHECK(basis.lambda(k) == doctest::Approx(l * (l + 1)).epsilon(0.01));
}

TEST_CASE("both methods give M-orthonormal eigenvectors of L, and the same spectrum") {
  for (const TriangleMesh& mesh : {with_radius(sphere(5), lump), squeezed_lump()}) {
    const Operators operators = make_operators(mesh);
    const Eigenbasis fast = solve(operators, EigenMethod::chebyshev, 120);
    const Eigenbasis reference = solve(operators, EigenMethod::spectra, 120);
    check_definition(operators, fast);
    check_definition(operators, reference);
    CHECK(largest_difference(fast.lambda, reference.lambda) < 1e-10);
    // The lump has no symmetry, so its eigenvectors are single and comparable one by one, signs included.
    CHECK((fast.Phi.leftCols(20) - reference.Phi.leftCols(20)).cwiseAbs().maxCoeff() < 1e-4);
  }
}

TEST_CASE("where the Chebyshev iteration does not converge, Spectra takes over") {
  const Operators operators = make_operators(with_radius(sphere(5), lump));
  EigenParams params;
  params.count = 60, params.max_rounds = 1;
  const Eigenbasis basis = eigenbasis(operators.L, operators.mass, params, {});
  const Eigenbasis reference = solve(operators, EigenMethod::spectra, 60);
  check_definition(operators, basis);
  CHECK(basis.lambda == reference.lambda);
  CHECK(basis.Phi == reference.Phi);
  CHECK(basis.lambda != solve(operators, EigenMethod::chebyshev, 60).lambda);  // it was not that one
}

TEST_CASE("repeated eigenvalues are found as often as they are there") {
  const Operators operators = make_operators(twins());
  const Eigenbasis basis = solve(operators, EigenMethod::chebyshev, 60);
  const Eigenbasis one = solve(make_operators(with_radius(sphere(4), lump)), EigenMethod::chebyshev, 30);
  CHECK(basis.lambda(1) < 1e-8 * basis.lambda(2));
  for (int j = 1; j < 30; ++j) {
    CHECK(basis.lambda(2 * j) == doctest::Approx(one.lambda(j)).epsilon(1e-9));
    CHECK(basis.lambda(2 * j + 1) == doctest::Approx(one.lambda(j)).epsilon(1e-9));
  }
}

TEST_CASE("the same bits for 1, 2 and 4 threads") {
  const Operators operators = make_operators(with_radius(sphere(5), lump));
  const Eigenbasis one = solve(operators, EigenMethod::chebyshev, 60, 1);
  for (const int threads : {2, 4}) {
    const Eigenbasis other = solve(operators, EigenMethod::chebyshev, 60, threads);
    CHECK(one.lambda == other.lambda);
    CHECK(one.Phi == other.Phi);
  }
}

TEST_CASE("small surfaces are solved densely; more pairs than there are is all but two") {
  const Operators tiny = make_operators(sphere(0));  // an octahedron, 6 vertices
  const Eigenbasis basis = solve(tiny, EigenMethod::chebyshev, 200);
  CHECK(basis.lambda.size() == 4);
  CHECK(basis.Phi.rows() == 6);
  check_definition(tiny, solve(tiny, EigenMethod::spectra, 3));
  const Operators small =
      make_operators(with_radius(sphere(3), lump));  // 258 vertices, just above the dense path
  const Eigenbasis dense = solve(small, EigenMethod::chebyshev, 150);
  const Eigenbasis blocks = solve(small, EigenMethod::chebyshev, 60);
  check_definition(small, blocks);
  CHECK(largest_difference(blocks.lambda, dense.lambda.head(60)) < 1e-10);
}

TEST_CASE("two vertices have no spectrum") {
  SparseMatrix L(2, 2);
  L.setIdentity();
  CHECK_THROWS_AS(eigenbasis(L, Vector::Ones(2), {}, {}), Error);
}

TEST_CASE("a cancelled task stops either method") {
  const Operators operators = make_operators(with_radius(sphere(6), lump));
  for (const EigenMethod method : {EigenMethod::chebyshev, EigenMethod::spectra}) {
    Task task;
    Execution execution;
    execution.task = &task;
    task.begin_stage("spectrum", 0, 1);
    std::thread canceller([&] {
      while (task.progress() == 0) std::this_thread::yield();
      task.cancel();
    });
    try {
      eigenbasis(operators.L, operators.mass, {200, method, 1e-8}, execution);
      FAIL("ran to its end");
    } catch (const Error& error) {
      CHECK(error.status() == Status::cancelled);
    }
    canceller.join();
    CHECK(task.progress() < 1);
  }
}
