#include "geodesics/half_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace focal {
namespace {

constexpr double surplus = 1e-6;  // of the angle around a vertex: the effect on a path is of its square

// Finds twins by sorting: two half-edges of opposite direction, and no third between the same vertices.
void find_twins(HalfEdges& edges) {
  const auto count = static_cast<int32_t>(edges.origin.size());
  const auto key = [&](int32_t h) {
    const int32_t a = edges.origin[h], b = edges.target(h);
    return std::pair(std::min(a, b), std::max(a, b));
  };
  std::vector<int32_t> order(count);
  for (int32_t h = 0; h < count; ++h) order[h] = h;
  const auto by_ends = [&](int32_t a, int32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); };
  std::sort(order.begin(), order.end(), by_ends);
  edges.twin.assign(count, -1);
  for (int32_t i = 0, end = 0; i < count; i = end) {
    for (end = i + 1; end < count && key(order[end]) == key(order[i]);) ++end;
    const int32_t a = order[i], b = order[std::min(i + 1, count - 1)];
    if (end - i == 2 && edges.origin[a] != edges.origin[b]) edges.twin[a] = b, edges.twin[b] = a;
  }
}

void find_apexes(HalfEdges& edges) {
  const size_t count = edges.origin.size();
  edges.apex_x.resize(count), edges.apex_y.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const auto h = static_cast<int32_t>(i);
    const double a = edges.length[h], b = edges.length[HalfEdges::next(h)],
                 c = edges.length[HalfEdges::previous(h)];
    edges.apex_x[h] = a > 0 ? (a * a + c * c - b * b) / (2 * a) : 0;
    // A degenerate triangle gets a small height, so that every line can cross it.
    edges.apex_y[h] = std::max(std::sqrt(std::max(c * c - edges.apex_x[h] * edges.apex_x[h], 0.0)),
                               1e-12 * std::max({a, b, c, 1e-300}));
  }
}

void find_bends(HalfEdges& edges, int32_t vertices, std::span<const std::pair<int32_t, int32_t>> bridges) {
  std::vector<double> angle(vertices, 0.0);
  edges.bends.assign(vertices, 0);
  for (int32_t h = 0; h < static_cast<int32_t>(edges.origin.size()); ++h) {
    angle[edges.origin[h]] += std::atan2(edges.apex_y[h], edges.apex_x[h]);
    if (edges.twin[h] < 0) edges.bends[edges.origin[h]] = edges.bends[edges.target(h)] = 1;
  }
  for (int32_t v = 0; v < vertices; ++v)
    if (angle[v] > 2 * std::numbers::pi + surplus) edges.bends[v] = 1;
  for (const auto& [a, b] : bridges) edges.bends[a] = edges.bends[b] = 1;
}

}  // namespace

HalfEdges half_edges_of(const TriangleMesh& mesh, std::span<const std::pair<int32_t, int32_t>> bridges) {
  HalfEdges edges;
  const int32_t n = mesh.vertex_count(), count = 3 * mesh.triangle_count();
  edges.origin.assign(mesh.triangles.data(), mesh.triangles.data() + count);
  for (int32_t h = 0; h < count; ++h)
    edges.length.push_back(
        (mesh.positions.row(edges.target(h)) - mesh.positions.row(edges.origin[h])).norm());
  edges.first.assign(n + 1, 0);
  for (const int32_t v : edges.origin) ++edges.first[v + 1];
  for (int32_t v = 0; v < n; ++v) edges.first[v + 1] += edges.first[v];
  edges.outgoing.resize(count);
  std::vector<int32_t> filled(edges.first.begin(), edges.first.end() - 1);
  for (int32_t h = 0; h < count; ++h) edges.outgoing[filled[edges.origin[h]]++] = h;
  find_twins(edges);
  find_apexes(edges);
  find_bends(edges, n, bridges);
  return edges;
}

}  // namespace focal
