#include "surface_points.h"

#include <cmath>

#include "base/error.h"

namespace focal {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& problem, const std::string& hint) {
  throw Error(Status::invalid_landmark, name + ": " + problem, hint);
}

Vector3 checked_weights(const focal_surface_point& point, const std::string& name) {
  const Vector3 weights(point.barycentric[0], point.barycentric[1], point.barycentric[2]);
  const double sum = weights.sum();
  if (!(weights.minCoeff() >= 0) || !(sum > 0) || !std::isfinite(sum))
    refuse(name, "its barycentric weights are no point of a triangle",
           "give three weights >= 0 that sum to 1");
  return weights / sum;
}

}  // namespace

SurfacePoint point_in(const PreparedMesh& mesh, const focal_surface_point& point, const std::string& name) {
  if (point.triangle >= static_cast<uint32_t>(mesh.source.triangle_count()))
    refuse(name, "the mesh has no triangle " + std::to_string(point.triangle),
           "triangles are numbered from 0 to " + std::to_string(mesh.source.triangle_count() - 1) +
               "; FOCAL_NO_TRIANGLE marks an absent landmark");
  const SurfacePoint source{static_cast<int32_t>(point.triangle), checked_weights(point, name)};
  const SurfacePoint on_surface = to_surface(mesh, source);
  if (on_surface.triangle >= 0) return on_surface;
  Eigen::Index heaviest = 0;
  source.barycentric.maxCoeff(&heaviest);
  return vertex_in(mesh, static_cast<uint32_t>(mesh.source.triangles(source.triangle, heaviest)), name);
}

SurfacePoint vertex_in(const PreparedMesh& mesh, uint32_t vertex, const std::string& name) {
  if (vertex >= static_cast<uint32_t>(mesh.source.vertex_count()))
    refuse(name, "the mesh has no vertex " + std::to_string(vertex),
           "vertices are numbered from 0 to " + std::to_string(mesh.source.vertex_count() - 1) +
               "; FOCAL_NO_VERTEX marks an absent landmark");
  const int32_t on_surface = mesh.surface_vertex[vertex];
  if (on_surface < 0)
    refuse(name, "no triangle uses vertex " + std::to_string(vertex), "mark a vertex of the surface");
  return at_vertex(mesh.surface, on_surface);
}

focal_surface_point point_out(const SurfacePoint& source_point) {
  if (source_point.triangle < 0) return {FOCAL_NO_TRIANGLE, {0, 0, 0}};
  focal_surface_point point{static_cast<uint32_t>(source_point.triangle), {}};
  position_out(source_point.barycentric, point.barycentric);
  return point;
}

void position_out(const Vector3& position, float* out) {
  for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(position[i]);
}

}  // namespace focal
