// Flips within the surface: same area and vertices, no negative weight, right where thin triangles are wrong.
#include "operators/intrinsic_delaunay.h"

#include <doctest/doctest.h>

#include <cmath>

#include "geodesics/heat_method.h"
#include "operators/operators.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

// The sphere's vertices pushed along it at random: thin and obtuse triangles everywhere, none turned over.
TriangleMesh irregular_sphere(int level, double amount) {
  TriangleMesh mesh = sphere(level);
  Random random(11);
  const double edge = mean_edge_length(mesh);
  for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v) {
    for (int i = 0; i < 3; ++i) mesh.positions(v, i) += amount * edge * random.normal();
    mesh.positions.row(v).normalize();
  }
  return mesh;
}

double area_of(const IntrinsicTriangulation& surface) {
  double area = 0;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) area += measure(surface.lengths.row(t), 0).area;
  return area;
}

}  // namespace

TEST_CASE("a thin diamond is flipped, to the length of its other diagonal") {
  TriangleMesh mesh;
  mesh.positions.resize(4, 3);
  mesh.positions << -1, 0, 0, 1, 0, 0, 0, 0.2, 0, 0, -0.2, 0;
  mesh.triangles.resize(2, 3);
  mesh.triangles << 0, 1, 2, 1, 0, 3;  // they share the long diagonal
  const IntrinsicTriangulation flipped = intrinsic_delaunay(mesh);
  CHECK(flipped.flips == 1);
  CHECK(area_of(flipped) == doctest::Approx(0.4));
  int short_edges = 0;
  for (int t = 0; t < 2; ++t)
    for (int i = 0; i < 3; ++i) short_edges += std::abs(flipped.lengths(t, i) - 0.4) < 1e-12;
  CHECK(short_edges == 2);
}

TEST_CASE("area and Euler number stay, every weight becomes positive") {
  const TriangleMesh mesh = irregular_sphere(4, 0.3);
  const Operators plain = make_operators(mesh), delaunay = make_operators(mesh, {}, true);
  const auto most = [](const Operators& o) {
    double largest = -1e9;
    for (int32_t j = 0; j < o.L.cols(); ++j)
      for (SparseMatrix::InnerIterator it(o.L, j); it; ++it)
        if (it.row() != j) largest = std::max(largest, it.value());
    return largest;
  };
  CHECK(most(plain) > 0.01);  // obtuse pairs
  CHECK(most(delaunay) < 1e-9);
  CHECK(intrinsic_delaunay(mesh).flips > 100);
  CHECK(area_of(intrinsic_delaunay(mesh)) == doctest::Approx(surface_area(mesh)).epsilon(1e-12));
  CHECK(delaunay.mass.sum() == doctest::Approx(surface_area(mesh)).epsilon(1e-9));
  CHECK((delaunay.L * Vector::Ones(mesh.vertex_count())).lpNorm<Eigen::Infinity>() < 1e-10);
}

TEST_CASE("a Delaunay mesh is left as it is, and a boundary stays") {
  CHECK(intrinsic_delaunay(sphere(3)).flips == 0);
  const TriangleMesh flat = square(6);
  const IntrinsicTriangulation same = intrinsic_delaunay(flat);
  CHECK(area_of(same) == doctest::Approx(surface_area(flat)));
}

TEST_CASE("heat distances over slanted triangles come nearer to the straight lines") {
  TriangleMesh mesh = square(25);
  mesh.positions.col(0) += 2 * mesh.positions.col(1);  // every triangle obtuse; the sheet stays convex
  const std::vector<int32_t> source = {25 * 51 + 25};
  const auto error = [&](bool delaunay) {
    const RowMatrixf d = HeatMethod(mesh, make_operators(mesh, {}, delaunay)).distances(source, {});
    double sum = 0;
    for (int32_t v = 0; v < mesh.vertex_count(); ++v)
      sum += std::abs(d(0, v) - (mesh.positions.row(v) - mesh.positions.row(source[0])).norm());
    return sum / mesh.vertex_count();
  };
  MESSAGE("mean error with and without: ", error(true), " ", error(false));
  CHECK(error(true) < 0.05);
  CHECK(error(true) < 0.5 * error(false));
}
