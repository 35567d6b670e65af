#include "mesh/triangle_mesh.h"

#include <algorithm>
#include <numeric>
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

Edges edges_of(const TriangleMesh& mesh) {
  // By the smaller end by counting, then the few at each vertex by the larger end.
  const int32_t n = mesh.vertex_count();
  const auto for_each_side = [&](const auto& visit) {
    for (int32_t t = 0; t < mesh.triangle_count(); ++t)
      for (int i = 0; i < 3; ++i) {
        const auto [a, b] = std::minmax(mesh.triangles(t, i), mesh.triangles(t, (i + 1) % 3));
        visit(a, b);
      }
  };
  std::vector<int32_t> start(n + 1, 0), other(static_cast<size_t>(mesh.triangles.size()));
  for_each_side([&](int32_t a, int32_t) { ++start[a + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int32_t> end(start.begin(), start.end() - 1);
  for_each_side([&](int32_t a, int32_t b) { other[end[a]++] = b; });
  Eigen::Index count = 0;
  for (int32_t v = 0; v < n; ++v) {
    std::sort(other.begin() + start[v], other.begin() + end[v]);
    end[v] =
        static_cast<int32_t>(std::unique(other.begin() + start[v], other.begin() + end[v]) - other.begin());
    count += end[v] - start[v];
  }
  Edges result(count, 2);
  Eigen::Index e = 0;
  for (int32_t v = 0; v < n; ++v)
    for (int32_t p = start[v]; p < end[v]; ++p) result.row(e++) << v, other[p];
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

int32_t nearest_corner(const TriangleMesh& mesh, const SurfacePoint& point) {
  int nearest = 0;
  point.barycentric.maxCoeff(&nearest);
  return mesh.triangles(point.triangle, nearest);
}

MatrixX3 area_normals(const TriangleMesh& mesh) {
  MatrixX3 normals = MatrixX3::Zero(mesh.vertex_count(), 3);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto at = [&](int i) -> Eigen::RowVector3d { return mesh.positions.row(mesh.triangles(t, i)); };
    const Eigen::RowVector3d cross = (at(1) - at(0)).cross(at(2) - at(0));
    for (int i = 0; i < 3; ++i) normals.row(mesh.triangles(t, i)) += cross;
  }
  return normals;
}

}  // namespace focal
