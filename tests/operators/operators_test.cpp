// The operators as identities: what they are on any mesh, and on surfaces known by formula.
#include "operators/operators.h"

#include <doctest/doctest.h>

#include <numbers>

#include "base/random.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

Vector random_function(Eigen::Index n, uint64_t seed) {
  Random random(seed);
  Vector u(n);
  for (double& value : u) value = random.normal();
  return u;
}

TriangleMesh two_spheres() {
  const TriangleMesh one = sphere(2);
  TriangleMesh both{MatrixX3(2 * one.vertex_count(), 3), MatrixX3i(2 * one.triangle_count(), 3)};
  both.positions << one.positions, one.positions.rowwise() + Eigen::RowVector3d(5, 0, 0);
  both.triangles << one.triangles, (one.triangles.array() + one.vertex_count()).matrix();
  return both;
}

}  // namespace

TEST_CASE("L = -div grad") {
  const TriangleMesh mesh = with_radius(sphere(4), lump);
  const Operators operators = make_operators(mesh);
  const Vector u = random_function(mesh.vertex_count(), 1);
  const Vector Lu = operators.L * u;
  CHECK((Lu + divergence(mesh, gradient(mesh, u))).lpNorm<Eigen::Infinity>() <
        1e-12 * Lu.lpNorm<Eigen::Infinity>());
}

TEST_CASE("L is symmetric, knows constants only, and is positive on the rest") {
  const TriangleMesh mesh = with_radius(sphere(3), lump);
  const Operators operators = make_operators(mesh);
  const Vector u = random_function(mesh.vertex_count(), 2), v = random_function(mesh.vertex_count(), 3);
  CHECK((operators.L * Vector::Ones(mesh.vertex_count())).lpNorm<Eigen::Infinity>() < 1e-12);
  CHECK(u.dot(operators.L * v) == doctest::Approx(v.dot(operators.L * u)).epsilon(1e-12));
  CHECK(u.dot(operators.L * u) > 0);
}

TEST_CASE("the mass is the area, all of it positive") {
  const TriangleMesh mesh = with_radius(sphere(3), lump);
  const Operators operators = make_operators(mesh);
  CHECK(operators.mass.sum() == doctest::Approx(surface_area(mesh)).epsilon(1e-12));
  CHECK(operators.area == doctest::Approx(surface_area(mesh)).epsilon(1e-12));
  CHECK(operators.mass.minCoeff() > 0);
  CHECK(operators.mean_edge == doctest::Approx(mean_edge_length(mesh)));
}

TEST_CASE("the Dirichlet energy of a coordinate on the unit sphere is 8 pi / 3") {
  const TriangleMesh mesh = sphere(5);
  const Vector x = mesh.positions.col(0);
  CHECK(x.dot(make_operators(mesh).L * x) == doctest::Approx(8 * std::numbers::pi / 3).epsilon(0.005));
}

TEST_CASE("the gradient of a linear function on the plane is exact") {
  const TriangleMesh mesh = square(6, 0.3);
  const Vector u = 2 * mesh.positions.col(0) - 3 * mesh.positions.col(1);
  const MatrixX3 g = gradient(mesh, u);
  CHECK((g.rowwise() - Eigen::RowVector3d(2, -3, 0)).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((face_normals(mesh).rowwise() - Eigen::RowVector3d(0, 0, 1)).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("bridges join the parts") {
  const TriangleMesh mesh = two_spheres();
  const int32_t half = mesh.vertex_count() / 2;
  Vector part = Vector::Zero(mesh.vertex_count());
  part.head(half).setOnes();
  CHECK((make_operators(mesh).L * part).lpNorm<Eigen::Infinity>() < 1e-12);
  const std::pair<int32_t, int32_t> bridge{0, half};
  const Operators bridged = make_operators(mesh, std::span(&bridge, 1));
  CHECK(part.dot(bridged.L * part) > 1e-6);
  CHECK((bridged.L * Vector::Ones(mesh.vertex_count())).lpNorm<Eigen::Infinity>() < 1e-12);
}

TEST_CASE("needles and triangles without area leave the operators finite") {
  TriangleMesh mesh = square(3);
  mesh.positions.row(24) = mesh.positions.row(25);  // two corners in one place
  mesh.positions.row(17) << mesh.positions(18, 0) - 1e-13, mesh.positions(18, 1), 0;
  const Operators operators = make_operators(mesh);
  CHECK(operators.mass.allFinite());
  CHECK(operators.mass.minCoeff() > 0);
  CHECK(Eigen::Map<const Vector>(operators.L.valuePtr(), operators.L.nonZeros()).allFinite());
  CHECK(gradient(mesh, mesh.positions.col(0)).allFinite());
}
