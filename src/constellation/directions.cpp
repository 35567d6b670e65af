#include <array>
#include <cmath>

#include "constellation/constellation.h"
#include "operators/operators.h"

namespace focal {
namespace {

// A triangle's frame for gradients: grad u = sum of u_i * hat_i.
struct Face {
  int32_t corner[3];
  Vector3 hat[3];
  double area;
};

Face face_of(const TriangleMesh& mesh, int32_t t, const MatrixX3& normals) {
  Face face;
  Vector3 at[3];
  for (int i = 0; i < 3; ++i) at[i] = mesh.positions.row(face.corner[i] = mesh.triangles(t, i));
  const double twice = (at[1] - at[0]).cross(at[2] - at[0]).norm();
  face.area = twice / 2;
  for (int i = 0; i < 3; ++i) {
    face.hat[i] = Vector3::Zero();
    if (twice > 0) face.hat[i] = normals.row(t).transpose().cross(at[(i + 2) % 3] - at[(i + 1) % 3]) / twice;
  }
  return face;
}

// Triangles entirely within the radius, or those around the point where the mesh is too coarse for that.
std::vector<int32_t> disc_round(const TriangleMesh& mesh, const SurfacePoint& point, const float* field,
                                double radius) {
  std::vector<int32_t> disc, ring;
  const auto& corner = mesh.triangles;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    if (field[corner(t, 0)] < radius && field[corner(t, 1)] < radius && field[corner(t, 2)] < radius)
      disc.push_back(t);
  if (disc.size() >= 4) return disc;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    bool touches = false;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        touches = touches || (point.barycentric[k] > 0 && corner(point.triangle, k) == corner(t, i));
    if (touches) ring.push_back(t);
  }
  return ring;
}

}  // namespace

TangentDirections tangent_directions(const TriangleMesh& mesh, std::span<const SurfacePoint> points,
                                     const RowMatrixf& fields, double radius, const Execution& execution) {
  const auto count = static_cast<int32_t>(points.size());
  const MatrixX3 normals = face_normals(mesh);
  TangentDirections result{RowMatrixf::Zero(count, count), RowMatrixf::Zero(count, count)};
  parallel_for(execution, count, [&](int64_t c) {
    std::vector<Face> faces;
    Vector3 normal = Vector3::Zero();
    double area = 0;
    for (const int32_t t : disc_round(mesh, points[c], &fields(c, 0), radius)) {
      faces.push_back(face_of(mesh, t, normals));
      normal += faces.back().area * normals.row(t).transpose();
      area += faces.back().area;
    }
    if (!(area > 0) || normal.isZero(0)) return;  // opposite sheets have no normal
    normal.normalize();
    const Vector3 e1 = normal.unitOrthogonal(), e2 = normal.cross(e1);
    for (int32_t a = 0; a < count; ++a) {
      Vector3 toward = Vector3::Zero();
      for (const Face& face : faces) {
        Vector3 g = Vector3::Zero();
        for (int i = 0; i < 3; ++i) g += static_cast<double>(fields(a, face.corner[i])) * face.hat[i];
        const double length = g.norm();
        if (length > 1e-12) toward -= face.area / length * g;
      }
      result.x(c, a) = static_cast<float>(e1.dot(toward) / area);
      result.y(c, a) = static_cast<float>(e2.dot(toward) / area);
    }
  });
  return result;
}

}  // namespace focal
