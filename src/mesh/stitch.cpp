#include "mesh/stitch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "mesh/box.h"

namespace focal {
namespace {

constexpr double nearly_meets = 2e-4;    // of the diagonal: 0.4 mm of a person
constexpr double min_edges_kept = 0.25;  // relative to the shortest edge at a vertex

Vector3 place_of(const MatrixX3& positions, int32_t v) { return positions.row(v).transpose(); }

double diagonal_of(const MatrixX3& positions) {
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
}

// For each vertex of a border the length of its shortest edge; 0: not on a border.
std::vector<double> shortest_edges_of_borders(const TriangleMesh& mesh, const EdgeSides& edges) {
  std::vector<double> shortest(static_cast<size_t>(mesh.vertex_count()),
                               std::numeric_limits<double>::infinity());
  std::vector<char> is_border(shortest.size(), 0);
  for (int32_t e = 0; e < edges.edge_count(); ++e) {
    const int32_t a = side_from(mesh.triangles, edges.of_edge(e)[0]);
    const int32_t b = side_to(mesh.triangles, edges.of_edge(e)[0]);
    const double length = (place_of(mesh.positions, a) - place_of(mesh.positions, b)).norm();
    for (const int32_t v : {a, b}) {
      shortest[v] = std::min(shortest[v], length);
      is_border[v] |= static_cast<char>(edges.of_edge(e).size() == 1);
    }
  }
  for (size_t v = 0; v < shortest.size(); ++v)
    if (!is_border[v]) shortest[v] = 0;
  return shortest;
}

MatrixX3 places_of(const MatrixX3& positions, const std::vector<int32_t>& vertices) {
  MatrixX3 result(static_cast<Eigen::Index>(vertices.size()), 3);
  for (size_t i = 0; i < vertices.size(); ++i)
    result.row(static_cast<Eigen::Index>(i)) = positions.row(vertices[i]);
  return result;
}

}  // namespace

std::vector<int32_t> first_at_place(const MatrixX3& positions, double tolerance) {
  std::unordered_map<uint64_t, std::vector<int32_t>> cells;
  const auto key = [](const Eigen::Vector3i& c) {
    return (static_cast<uint64_t>(static_cast<uint32_t>(c[0]) & 0x1FFFFF) << 42) |
           (static_cast<uint64_t>(static_cast<uint32_t>(c[1]) & 0x1FFFFF) << 21) |
           (static_cast<uint32_t>(c[2]) & 0x1FFFFF);
  };
  Box box;
  for (int32_t v = 0; v < positions.rows(); ++v) box.add(place_of(positions, v));
  std::vector<int32_t> first(static_cast<size_t>(positions.rows()));
  for (int32_t v = 0; v < positions.rows(); ++v) {
    const Vector3 p = place_of(positions, v);
    // Relative to the box's corner: a position far from the origin would overflow int.
    const Eigen::Vector3i cell = ((p - box.low) / (2 * tolerance)).array().floor().cast<int>();
    first[v] = v;
    for (int corner = 0; corner < 27 && first[v] == v; ++corner) {
      const auto there =
          cells.find(key(cell + Eigen::Vector3i(corner % 3 - 1, corner / 3 % 3 - 1, corner / 9 - 1)));
      if (there == cells.end()) continue;
      for (const int32_t other : there->second)
        if ((place_of(positions, other) - p).norm() < tolerance) {
          first[v] = other;
          break;
        }
    }
    if (first[v] == v) cells[key(cell)].push_back(v);
  }
  return first;
}

std::vector<int32_t> stitched_borders(const TriangleMesh& mesh, const EdgeSides& edges) {
  const std::vector<double> shortest = shortest_edges_of_borders(mesh, edges);
  std::vector<int32_t> border;
  for (int32_t v = 0; v < mesh.vertex_count(); ++v)
    if (shortest[v] > 0) border.push_back(v);
  const double tolerance = nearly_meets * diagonal_of(mesh.positions);
  if (border.empty() || !(tolerance > 0) || !std::isfinite(tolerance)) return {};
  const std::vector<int32_t> first = first_at_place(places_of(mesh.positions, border), tolerance);
  std::vector<int32_t> result;
  for (size_t i = 0; i < border.size(); ++i) {
    const int32_t v = border[i], other = border[first[i]];
    const double distance = (place_of(mesh.positions, v) - place_of(mesh.positions, other)).norm();
    if (v == other || distance >= min_edges_kept * std::min(shortest[v], shortest[other])) continue;
    if (result.empty()) {
      result.resize(static_cast<size_t>(mesh.vertex_count()));
      for (int32_t u = 0; u < mesh.vertex_count(); ++u) result[u] = u;
    }
    result[v] = other;
  }
  return result;
}

}  // namespace focal
