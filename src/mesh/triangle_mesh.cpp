#include "mesh/triangle_mesh.h"

#include <algorithm>
#include <vector>

namespace focal {

double surface_area(const TriangleMesh& mesh) {
  double twice = 0;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto corners = mesh.triangles.row(t);
    const Vector3 a = mesh.positions.row(corners[0]);
    twice += (mesh.positions.row(corners[1]).transpose() - a)
                 .cross(mesh.positions.row(corners[2]).transpose() - a)
                 .norm();
  }
  return twice / 2;
}

Eigen::Matrix<int32_t, Eigen::Dynamic, 2, Eigen::RowMajor> edges_of(const TriangleMesh& mesh) {
  std::vector<std::pair<int32_t, int32_t>> edges;
  edges.reserve(3 * static_cast<size_t>(mesh.triangle_count()));
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i)
      edges.push_back(std::minmax({mesh.triangles(t, i), mesh.triangles(t, (i + 1) % 3)}));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  Eigen::Matrix<int32_t, Eigen::Dynamic, 2, Eigen::RowMajor> result(edges.size(), 2);
  for (size_t e = 0; e < edges.size(); ++e) result.row(e) << edges[e].first, edges[e].second;
  return result;
}

double mean_edge_length(const TriangleMesh& mesh) {
  const auto edges = edges_of(mesh);
  double sum = 0;
  for (Eigen::Index e = 0; e < edges.rows(); ++e)
    sum += (mesh.positions.row(edges(e, 0)) - mesh.positions.row(edges(e, 1))).norm();
  return edges.rows() ? sum / edges.rows() : 0;
}

Vector3 position_of(const TriangleMesh& mesh, const SurfacePoint& point) {
  Vector3 position = Vector3::Zero();
  for (int i = 0; i < 3; ++i)
    position += point.barycentric[i] * mesh.positions.row(mesh.triangles(point.triangle, i)).transpose();
  return position;
}

}  // namespace focal
