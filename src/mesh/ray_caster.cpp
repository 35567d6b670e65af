#include "mesh/ray_caster.h"

#include <algorithm>
#include <limits>

namespace focal {
namespace {

double distance_to(const TriangleMesh& mesh, int32_t t, const Vector3& origin, const Vector3& direction) {
  const Vector3 a = mesh.positions.row(mesh.triangles(t, 0));
  const Vector3 ab = mesh.positions.row(mesh.triangles(t, 1)).transpose() - a,
                ac = mesh.positions.row(mesh.triangles(t, 2)).transpose() - a;
  const Vector3 across = direction.cross(ac);
  const double determinant = ab.dot(across);
  if (determinant == 0) return -1;
  const Vector3 from_a = origin - a;
  const double u = from_a.dot(across) / determinant;
  const Vector3 other = from_a.cross(ab);
  const double v = direction.dot(other) / determinant;
  if (!(u >= 0 && v >= 0 && u + v <= 1)) return -1;
  return ac.dot(other) / determinant;
}

// Distance at which the ray enters the box, infinite if it misses.
double entry(const Eigen::AlignedBox3d& box, const Vector3& origin, const Vector3& direction,
             double farthest) {
  constexpr double never = std::numeric_limits<double>::infinity();
  double low = 0, high = farthest;
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0) {
      if (origin[i] < box.min()[i] || origin[i] > box.max()[i]) return never;
      continue;
    }
    const double a = (box.min()[i] - origin[i]) / direction[i], b = (box.max()[i] - origin[i]) / direction[i];
    low = std::max(low, std::min(a, b)), high = std::min(high, std::max(a, b));
  }
  return low <= high ? low : never;
}

}  // namespace

RayCaster::Hit RayCaster::first_hit(const Vector3& origin, const Vector3& direction, double farthest) const {
  Hit hit{farthest, -1};
  tree_.search([&](const Eigen::AlignedBox3d& box) { return entry(box, origin, direction, hit.distance); },
               [&] { return hit.distance; },
               [&](int32_t t) {
                 const double distance = distance_to(mesh_, t, origin, direction);
                 if (distance > 0 && distance < hit.distance) hit = {distance, t};
               });
  return hit;
}

}  // namespace focal
