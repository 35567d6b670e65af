#include "landmarks/embedded_surface.h"

#include <algorithm>
#include <limits>

namespace focal {
namespace {

// Barycentric weights of the nearest point of a triangle, from the dot products of its sides from corner a
// and of the vector to p.
Vector3 closest_weights(double bb, double bc, double cc, double bp, double cp) {
  const double det = bb * cc - bc * bc;
  if (det > 0) {
    const double b = (cc * bp - bc * cp) / det, c = (bb * cp - bc * bp) / det;
    if (b >= 0 && c >= 0 && b + c <= 1) return {1 - b - c, b, c};
  }
  // Outside: the nearest of the nearest points of the three sides.
  const auto clamped = [](double along, double length) {
    return length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
  };
  const double b = clamped(bp, bb), c = clamped(cp, cc);
  const double side = clamped(bb - bc + cp - bp, bb - 2 * bc + cc);  // from b to c
  const Vector3 options[3] = {{1 - b, b, 0}, {1 - c, 0, c}, {0, 1 - side, side}};
  const auto cost = [&](const Vector3& w) {  // squared distance, less a constant
    return w[1] * w[1] * bb + 2 * w[1] * w[2] * bc + w[2] * w[2] * cc - 2 * (w[1] * bp + w[2] * cp);
  };
  return *std::min_element(options, options + 3,
                           [&](const auto& x, const auto& y) { return cost(x) < cost(y); });
}

}  // namespace

std::vector<std::vector<int32_t>> incident_triangles(const TriangleMesh& mesh) {
  std::vector<std::vector<int32_t>> result(mesh.vertex_count());
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) result[mesh.triangles(t, i)].push_back(t);
  return result;
}

EmbeddedSurface::Nearest EmbeddedSurface::nearest(int32_t triangle, const Eigen::VectorXf& place) const {
  const Eigen::VectorXf a = place_(mesh_.triangles(triangle, 0)),
                        ab = place_(mesh_.triangles(triangle, 1)) - a,
                        ac = place_(mesh_.triangles(triangle, 2)) - a, ap = place - a;
  const Vector3 weight =
      closest_weights(ab.squaredNorm(), ab.dot(ac), ac.squaredNorm(), ab.dot(ap), ac.dot(ap));
  return {{triangle, weight},
          (ap - static_cast<float>(weight[1]) * ab - static_cast<float>(weight[2]) * ac).squaredNorm()};
}

SurfacePoint EmbeddedSurface::nearest(const std::vector<int32_t>& triangles,
                                      const Eigen::VectorXf& place) const {
  Nearest best{{}, std::numeric_limits<float>::infinity()};
  for (const int32_t t : triangles)
    if (const Nearest next = nearest(t, place); next.squared < best.squared) best = next;
  return best.point;
}

}  // namespace focal
