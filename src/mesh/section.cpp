#include "mesh/section.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace focal {
namespace {

constexpr double pi = std::numbers::pi;

// Radius of the largest ball inside that touches the surface at a point: J. Ma, S. W. Bae, S. Choi, "3D
// medial axis point approximation using nearest neighbors and the normal field", 2012. Vertices within 40
// degrees of the point, seen from the ball's centre, count as the point's own neighbourhood; otherwise noise
// would shrink the ball.
double inscribed_radius(const TriangleMesh& mesh, const Vector3& point, const Vector3& inward,
                        double radius) {
  const double own_surroundings = std::cos(40 * pi / 180);
  for (int round = 0; round < 30; ++round) {
    const Vector3 centre = point + radius * inward;
    double smallest = radius;
    for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v) {
      const Vector3 other = mesh.positions.row(v).transpose();
      if ((other - centre).squaredNorm() >= radius * radius) continue;
      const Vector3 away = other - point;
      const double through =
          away.squaredNorm() / (2 * away.dot(inward));  // radius of the ball that touches both
      if (!(through < smallest)) continue;
      const Vector3 middle = point + through * inward;
      if ((other - middle).dot(point - middle) < own_surroundings * through * through) smallest = through;
    }
    if (smallest > radius * (1 - 1e-6)) break;
    radius = smallest;
  }
  return radius;
}

// Evenly distributed directions (a Fibonacci lattice).
Vector3 direction_of(int index, int count) {
  const double z = 1 - (2 * index + 1.0) / count, turn = index * pi * (3 - std::sqrt(5.0)),
               r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

// The direction of the longest extent of the body around a point inside it.
Vector3 long_axis(const RayCaster& surface, const Vector3& centre, double most) {
  constexpr int count = 128;
  Matrix3 moment = Matrix3::Zero();
  for (int i = 0; i < count; ++i) {
    const Vector3 direction = direction_of(i, count);
    const double reach = surface.first_hit(centre, direction, most).distance;
    moment += reach * reach * direction * direction.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Matrix3>(moment).eigenvectors().col(2);
}

// Centroid of the part of the plane through a point that is visible from it inside the body.
Vector3 centroid_across(const RayCaster& surface, const Vector3& centre, const Vector3& axis, double most) {
  constexpr int count = 32;
  const Vector3 u = axis.unitOrthogonal(), v = axis.cross(u);
  Vector3 sum = Vector3::Zero();
  double area = 0;
  Vector3 corner[count];
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * pi * i / count;
    const Vector3 direction = std::cos(angle) * u + std::sin(angle) * v;
    corner[i] = surface.first_hit(centre, direction, most).distance * direction;
  }
  for (int i = 0; i < count; ++i) {
    const Vector3 &a = corner[i], &b = corner[(i + 1) % count];
    const double twice = axis.dot(a.cross(b));
    sum += twice * (a + b) / 3, area += twice;
  }
  return area > 0 ? Vector3(centre + sum / area) : centre;
}

}  // namespace

double winding_number(const TriangleMesh& mesh, const Vector3& point) {
  double solid_angle = 0;  // A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", 1983
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    Vector3 at[3];
    for (int i = 0; i < 3; ++i) at[i] = mesh.positions.row(mesh.triangles(t, i)).transpose() - point;
    const double a = at[0].norm(), b = at[1].norm(), c = at[2].norm();
    solid_angle +=
        2 * std::atan2(at[0].dot(at[1].cross(at[2])),
                       a * b * c + at[0].dot(at[1]) * c + at[1].dot(at[2]) * a + at[2].dot(at[0]) * b);
  }
  return solid_angle / (4 * pi);
}

Vector3 section_centre(const RayCaster& surface, const Vector3& point, const Vector3& outward) {
  const Vector3 inward = -outward;
  const MatrixX3& positions = surface.mesh().positions;
  const double size = (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
  // Not wider than the extent through the body, which vertices far apart do not show.
  const double skin = 1e-3 * size;
  const double through = surface.first_hit(point + skin * inward, inward, size).distance;
  const double radius = inscribed_radius(surface.mesh(), point, inward, through / 2);
  const double longest = 6 * radius,
               widest = 3 * radius;  // farther hits are another part, or outside through a hole
  Vector3 centre = point + radius * inward;
  for (int round = 0; round < 3; ++round)
    centre = centroid_across(surface, centre, long_axis(surface, centre, longest), widest);
  return centre;
}

Vector3 drawn_inside(const RayCaster& surface, const Vector3& point) {
  const TriangleMesh& mesh = surface.mesh();
  if (winding_number(mesh, point) >= 0.5) return point;
  Eigen::Index nearest = 0;
  (mesh.positions.rowwise() - point.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
  const Vector3 normal = area_normals(mesh).row(nearest);
  return section_centre(surface, mesh.positions.row(nearest), normal.stableNormalized());
}

}  // namespace focal
