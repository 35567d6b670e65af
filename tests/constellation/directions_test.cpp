// Ways from point to point on surfaces where they are straight lines, and what a reflection does to them.
#include <doctest/doctest.h>

#include <cmath>

#include "constellation/constellation.h"
#include "geodesics/heat_method.h"
#include "mesh/prepare.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

TangentDirections directions_on(const TriangleMesh& mesh, const std::vector<int32_t>& vertices,
                                double radius) {
  std::vector<SurfacePoint> points;
  for (const int32_t v : vertices) points.push_back(at_vertex(mesh, v));
  const RowMatrixf fields = HeatMethod(mesh, make_operators(mesh)).distances(vertices, {});
  return tangent_directions(mesh, points, fields, radius, {});
}

}  // namespace

TEST_CASE("on the plane, chirality is the sine of the angle between the ways") {
  const TriangleMesh mesh = square(25, 0.2);
  const std::vector<int32_t> vertices = {25 * 51 + 25, 25 * 51 + 40, 40 * 51 + 30, 12 * 51 + 12};
  const TangentDirections directions = directions_on(mesh, vertices, 0.1);
  for (int c = 0; c < 4; ++c)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        if (c == a || c == b || a == b) continue;
        const Vector3 to_a = (mesh.positions.row(vertices[a]) - mesh.positions.row(vertices[c])).normalized();
        const Vector3 to_b = (mesh.positions.row(vertices[b]) - mesh.positions.row(vertices[c])).normalized();
        CHECK(directions.chirality(c, a, b) == doctest::Approx(to_a.cross(to_b).z()).epsilon(0.05).scale(1));
        CHECK(directions.chirality(c, a, b) == -directions.chirality(c, b, a));
      }
}

TEST_CASE("an isometry keeps chirality, a reflection negates it") {
  const TriangleMesh mesh = with_radius(sphere(4), lump);
  const std::vector<int32_t> vertices = {3, 250, 611, 1000};
  const TangentDirections before = directions_on(mesh, vertices, 0.25);
  Random random(8);
  TriangleMesh turned = mesh, mirrored = mesh;
  turned.positions = (mesh.positions * random_rotation(random)).eval();
  mirrored.positions.col(0) *= -1;
  mirrored.triangles.col(1).swap(mirrored.triangles.col(2));  // still counter-clockwise from outside
  const TangentDirections same = directions_on(turned, vertices, 0.25);
  const TangentDirections opposite = directions_on(mirrored, vertices, 0.25);
  double largest = 0;
  for (int c = 0; c < 4; ++c)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        CHECK(std::abs(same.chirality(c, a, b) - before.chirality(c, a, b)) < 1e-3);
        CHECK(std::abs(opposite.chirality(c, a, b) + before.chirality(c, a, b)) < 1e-3);
        largest = std::max<double>(largest, std::abs(before.chirality(c, a, b)));
      }
  CHECK(largest > 0.3);  // there was something to negate
}
