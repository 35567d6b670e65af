// The Laplacian where triangles make no surface: the ordinary one where they do, and on three sheets that share a spine what
// calculus says of them.
#include "operators/tufted_cover.h"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "geodesics/heat_method.h"
#include "operators/intrinsic_delaunay.h"
#include "operators/operators.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

using Dense = Eigen::MatrixXd;

TriangleMesh rough(TriangleMesh mesh, double amount, uint64_t seed) {
  Random random(seed);
  const double edge = mean_edge_length(mesh);
  for (Eigen::Index i = 0; i < mesh.positions.size(); ++i)
    mesh.positions.data()[i] += amount * edge * random.normal();
  return mesh;
}

// The same corners of triangles in other orders: some are turned over, so neighbours disagree.
TriangleMesh half_turned_over(TriangleMesh mesh) {
  for (int32_t t = 0; t < mesh.triangle_count(); t += 2)
    std::swap(mesh.triangles(t, 1), mesh.triangles(t, 2));
  return mesh;
}

void check_laplacian(const Operators& operators) {
  const Dense L = operators.L;
  CHECK((L - L.transpose()).cwiseAbs().maxCoeff() == 0);
  CHECK((L * Vector::Ones(L.rows())).cwiseAbs().maxCoeff() < 1e-9 * L.cwiseAbs().maxCoeff());
  CHECK((L - Dense(L.diagonal().asDiagonal())).maxCoeff() < 1e-8);  // no negative weight
  CHECK(Eigen::SelfAdjointEigenSolver<Dense>(L).eigenvalues()[0] > -1e-9 * L.cwiseAbs().maxCoeff());
  CHECK(operators.mass.minCoeff() > 0);
}

}  // namespace

TEST_CASE("the sides of a surface find each other, those of anything else do not") {
  const TriangleMesh closed = sphere(2);
  const auto twin = manifold_gluing(closed.triangles, edge_sides(closed));
  REQUIRE(twin.has_value());
  for (size_t s = 0; s < twin->size(); ++s) CHECK((*twin)[(*twin)[s]] == static_cast<int32_t>(s));
  for (const TriangleMesh& mesh : {book(2), moebius_strip(20, 2), half_turned_over(closed)})
    CHECK_FALSE(manifold_gluing(mesh.triangles, edge_sides(mesh)).has_value());
}

TEST_CASE("a cover is a closed surface: every side has a twin that runs back along its edge") {
  for (const TriangleMesh& mesh : {sphere(2), square(3), book(3), moebius_strip(20, 2)}) {
    const TuftedCover cover = tufted_cover(mesh.triangles, edge_sides(mesh));
    for (int32_t s = 0; s < 6 * mesh.triangle_count(); ++s) {
      const int32_t twin = cover.twin[s];
      REQUIRE(twin >= 0);
      CHECK(twin != s);
      CHECK(cover.twin[twin] == s);
      CHECK(side_from(cover.triangles, s) == side_to(cover.triangles, twin));
      CHECK(side_to(cover.triangles, s) == side_from(cover.triangles, twin));
    }
  }
}

TEST_CASE("over a closed surface the cover gives the ordinary Laplacian") {
  const TriangleMesh mesh = rough(with_radius(sphere(3), lump), 0.2, 5);
  const Operators ordinary = make_operators(mesh, {}, true);
  const Operators covered = make_operators(half_turned_over(mesh), {}, true);
  REQUIRE(ordinary.triangles.rows() == mesh.triangle_count());
  REQUIRE(covered.triangles.rows() == 2 * mesh.triangle_count());
  CHECK((Dense(ordinary.L) - Dense(covered.L)).cwiseAbs().maxCoeff() < 1e-8);
  CHECK(covered.mass.sum() == doctest::Approx(ordinary.mass.sum()).epsilon(1e-12));
  check_laplacian(ordinary);
  check_laplacian(covered);
}

TEST_CASE("three sheets that share a spine: energy and area are the sums over the sheets") {
  const TriangleMesh mesh = book(5);
  const Operators operators = make_operators(mesh, {}, true);
  REQUIRE(operators.triangles.rows() == 2 * mesh.triangle_count());
  check_laplacian(operators);
  CHECK(operators.mass.sum() == doctest::Approx(3 * 4).epsilon(1e-9));
  const Vector z = mesh.positions.col(2);  // of gradient 1 on all sheets, each of area 4
  CHECK(z.dot(operators.L * z) == doctest::Approx(12).epsilon(1e-9));
  const Vector out = mesh.positions.leftCols(2).rowwise().norm();  // likewise
  CHECK(out.dot(operators.L * out) == doctest::Approx(12).epsilon(1e-9));
  // Harmonic where the slopes on the three sheets sum to 0: here 2, -1 and -1.
  Vector u = out;
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) u[v] *= mesh.positions(v, 0) > 0 ? 2 : -1;
  const Vector Lu = operators.L * u;
  for (int32_t v = 0; v < mesh.vertex_count(); ++v)
    if (out[v] < 1.9 && std::abs(z[v]) < 0.99) CHECK(std::abs(Lu[v]) < 1e-9);
}

TEST_CASE("distances on the sheets are those along them") {
  const TriangleMesh mesh = book(12);
  const HeatMethod heat(mesh, make_operators(mesh, {}, true));
  const int32_t source = 12 + 25 + 24 * 12;  // somewhere on the first sheet
  const RowMatrixf d = heat.distances(std::vector<int32_t>{source}, {});
  const Eigen::RowVector3d from = mesh.positions.row(source);
  double sum = 0;
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
    REQUIRE(std::isfinite(d(0, v)));
    const bool same_sheet = mesh.positions(v, 0) >= 0;
    const double out = mesh.positions.row(v).head<2>().norm(), across = from.head<2>().norm();
    const double truth = std::hypot(same_sheet ? out - across : out + across, mesh.positions(v, 2) - from[2]);
    sum += std::abs(d(0, v) - truth) / mesh.vertex_count();
  }
  MESSAGE("mean error: ", sum);
  CHECK(sum < 0.06);
}

TEST_CASE("rough and one-sided surfaces have no negative weight either") {
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    check_laplacian(make_operators(rough(book(4), 0.3, seed), {}, true));
    check_laplacian(make_operators(rough(moebius_strip(24, 4), 0.3, seed), {}, true));
  }
}

TEST_CASE("lengths are mollified where a triangle is flat, by what it lacks, and else not at all") {
  const TriangleMesh sound = sphere(3);
  MatrixX3 lengths = intrinsic_copy(sound).lengths;
  mollify(lengths, 1e-5);
  CHECK(lengths == intrinsic_copy(sound).lengths);
  TriangleMesh flat = square(4);
  flat.positions.row(40) =
      (flat.positions.row(30) + flat.positions.row(50)) / 2 + Eigen::RowVector3d(1e-13, 0, 0);
  MatrixX3 before = intrinsic_copy(flat).lengths;
  before(0, 0) = before(0, 1) + before(0, 2);
  MatrixX3 after = before;
  mollify(after, 1e-5);
  const double slack = 1e-5 * before.mean();
  CHECK((after - before).maxCoeff() == doctest::Approx(slack).epsilon(1e-6));
  CHECK((after - before).minCoeff() == doctest::Approx(slack).epsilon(1e-6));
  for (Eigen::Index t = 0; t < after.rows(); ++t)
    CHECK(after.row(t).sum() - 2 * after.row(t).maxCoeff() > 0.999 * slack);
}
