// Nearest places on triangles and surfaces, against a dense search; thin parts keep their two sides.
#include "mesh/closest_point.h"

#include <doctest/doctest.h>

#include "surfaces.h"

using namespace focal;
using namespace focal_test;

TEST_CASE("the nearest point of a triangle is no farther than any of a fine net of its points") {
  Random random(5);
  const auto any = [&] { return Vector3(random.normal(), random.normal(), random.normal()); };
  for (int trial = 0; trial < 300; ++trial) {
    const Vector3 a = any(), b = any(), c = any(), p = 2 * any();
    const Vector3 w = closest_on_triangle(p, a, b, c);
    CHECK(w.minCoeff() >= 0);
    CHECK(w.sum() == doctest::Approx(1));
    const double found = (w[0] * a + w[1] * b + w[2] * c - p).norm();
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; i + j <= 20; ++j) {
        const Vector3 q = (i * a + j * b + (20 - i - j) * c) / 20;
        CHECK(found <= (q - p).norm() + 1e-9);
      }
  }
}

TEST_CASE("places near a sphere are found, whatever the first radius") {
  const TriangleMesh mesh = sphere(4);
  Random random(6);
  std::vector<SurfaceQuery> queries;
  for (int i = 0; i < 50; ++i) {
    const Vector3 way = Vector3(random.normal(), random.normal(), random.normal()).normalized();
    queries.push_back({(0.9 + 0.3 * random.uniform()) * way, way});
  }
  for (const double radius : {1e-6, 0.05, 10.0}) {
    const auto points = closest_points(mesh, queries, radius);
    for (size_t i = 0; i < queries.size(); ++i)
      CHECK((position_of(mesh, points[i]) - queries[i].normal).norm() < 0.05);
  }
}

TEST_CASE("between two sheets the side that faces the same way is taken") {
  TriangleMesh mesh;  // one triangle facing up at height 0.1, one facing down at 0
  mesh.positions.resize(6, 3);
  mesh.positions << 0, 0, 0.1, 1, 0, 0.1, 0, 1, 0.1, 0, 0, 0, 0, 1, 0, 1, 0, 0;
  mesh.triangles.resize(2, 3);
  mesh.triangles << 0, 1, 2, 3, 4, 5;
  const Vector3 place(0.2, 0.2, 0.01);
  const SurfaceQuery up{place, Vector3::UnitZ()}, down{place, -Vector3::UnitZ()}, any{place, Vector3::Zero()};
  CHECK(closest_points(mesh, std::span(&up, 1), 0.5)[0].triangle == 0);
  CHECK(closest_points(mesh, std::span(&down, 1), 0.5)[0].triangle == 1);
  CHECK(closest_points(mesh, std::span(&any, 1), 0.5)[0].triangle == 1);
}

TEST_CASE("many queries get what each gets alone, to the last bit") {
  const TriangleMesh mesh = sphere(4);
  Random random(7);
  std::vector<SurfaceQuery> queries;
  for (int i = 0; i < 700; ++i) {
    const Vector3 any(random.normal(), random.normal(), random.normal());
    const int corner = i % mesh.vertex_count();  // as near to several triangles
    const Vector3 at = i % 3 == 0 ? Vector3(mesh.positions.row(corner).transpose()) : Vector3(0.7 * any);
    queries.push_back({at, i % 2 == 0 ? Vector3::Zero().eval() : any});
  }
  const auto together = closest_points(mesh, queries, 0.01);
  for (size_t i = 0; i < queries.size(); ++i) {
    const SurfacePoint alone = closest_points(mesh, std::span(&queries[i], 1), 10)[0];
    CHECK(together[i].triangle == alone.triangle);
    CHECK(together[i].barycentric == alone.barycentric);
  }
}

TEST_CASE("where nothing faces the query's way any triangle will do") {
  TriangleMesh mesh;
  mesh.positions = MatrixX3::Identity(3, 3);
  mesh.triangles.resize(1, 3);
  mesh.triangles << 0, 1, 2;
  const std::vector<SurfaceQuery> queries(600, {Vector3(1, 1, 1), -Vector3::Ones()});
  for (const SurfacePoint& point : closest_points(mesh, queries, 0.1)) CHECK(point.triangle == 0);
}
