// Rays against planes and every triangle; centres of tubes, whose axes are known.
#include "mesh/section.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

// A capsule along x of half-length `half`, its round sections stretched by `flat` in z.
TriangleMesh capsule(double half, double flat) {
  TriangleMesh mesh = sphere(5);
  for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v) {
    mesh.positions(v, 0) += mesh.positions(v, 0) > 0 ? half : -half;
    mesh.positions(v, 2) *= flat;
  }
  return mesh;
}

Vector3 random_direction(Random& random) {
  return Vector3(random.normal(), random.normal(), random.normal()).normalized();
}

}  // namespace

TEST_CASE("a ray meets a sphere where it should, from inside and from outside") {
  const RayCaster rays(sphere(5));
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Vector3 direction = random_direction(random);
    CHECK(rays.first_hit(Vector3::Zero(), direction).distance == doctest::Approx(1).epsilon(2e-3));
    CHECK(rays.first_hit(3 * direction, -2 * direction).distance == doctest::Approx(1).epsilon(2e-3));
    CHECK(rays.first_hit(3 * direction, direction).triangle == -1);
    CHECK(rays.first_hit(3 * direction, -direction, 1.9).triangle == -1);
  }
}

TEST_CASE("the first hit is the nearest over all triangles") {
  TriangleMesh soup{MatrixX3::Zero(300, 3), MatrixX3i(100, 3)};
  Random random(2);
  for (Eigen::Index v = 0; v < 300; ++v)
    soup.positions.row(v) << random.normal(), random.normal(), random.normal();
  for (int t = 0; t < 100; ++t) soup.triangles.row(t) << 3 * t, 3 * t + 1, 3 * t + 2;
  const RayCaster rays(soup);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3 origin(random.normal(), random.normal(), random.normal());
    const Vector3 direction = i % 3 ? random_direction(random) : Vector3(Matrix3::Identity().col(i / 3 % 3));
    double nearest = std::numeric_limits<double>::infinity();
    for (int t = 0; t < 100; ++t) {
      Matrix3 sides;
      const Vector3 a = soup.positions.row(3 * t);
      sides << soup.positions.row(3 * t + 1).transpose() - a, soup.positions.row(3 * t + 2).transpose() - a,
          -direction;
      const Vector3 at = sides.inverse() * (origin - a);
      if (at[0] >= 0 && at[1] >= 0 && at[0] + at[1] <= 1 && at[2] > 0) nearest = std::min(nearest, at[2]);
    }
    const auto hit = rays.first_hit(origin, direction);
    hits += hit.triangle >= 0;
    if (std::isinf(nearest))
      CHECK(hit.triangle == -1);
    else
      CHECK(hit.distance == doctest::Approx(nearest));
  }
  CHECK(hits > 50);
  CHECK(RayCaster(TriangleMesh{}).first_hit(Vector3::Zero(), Vector3::UnitX()).triangle == -1);
}

TEST_CASE("the winding number tells inside from outside, by half where half the surface is gone") {
  TriangleMesh ball = sphere(4);
  CHECK(winding_number(ball, {0.2, 0.3, -0.4}) == doctest::Approx(1));
  CHECK(winding_number(ball, {1.2, 0.3, -0.4}) == doctest::Approx(0));
  TriangleMesh half = ball;
  int32_t kept = 0;
  for (int32_t t = 0; t < ball.triangle_count(); ++t)
    if (ball.positions.row(ball.triangles(t, 0))[2] + ball.positions.row(ball.triangles(t, 1))[2] +
            ball.positions.row(ball.triangles(t, 2))[2] >
        0)
      half.triangles.row(kept++) = ball.triangles.row(t);
  half.triangles.conservativeResize(kept, 3);
  CHECK(winding_number(half, Vector3::Zero()) == doctest::Approx(0.5));
}

TEST_CASE("under every point of a limb's side lies its axis, whether it is round or flat") {
  for (const double flat : {1.0, 0.5}) {
    const RayCaster rays(capsule(4, flat));
    for (const double x : {-2.0, 0.0, 1.5})
      for (double angle = 0.1; angle < 6; angle += 0.7) {
        const Vector3 point(x, std::cos(angle), flat * std::sin(angle));
        const Vector3 normal = Vector3(0, std::cos(angle), std::sin(angle) / flat).normalized();
        const Vector3 centre = section_centre(rays, point, normal);
        CHECK(std::hypot(centre[1], centre[2]) < 0.05);
        CHECK(std::abs(centre[0] - x) < 0.3);
      }
  }
}

TEST_CASE("a plane has nothing under it: the centre is finite all the same") {
  const RayCaster rays(square(5));
  CHECK(section_centre(rays, Vector3::Zero(), Vector3::UnitZ()).allFinite());
}
