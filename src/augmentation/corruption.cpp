#include "augmentation/corruption.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <queue>

#include "mesh/components.h"

namespace focal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double at_corner = 1 - 1e-9;  // a landmark with a weight of at least this is at a vertex

struct Neighbours {
  std::vector<int32_t> start, vertex;
  std::vector<double> length;
  explicit Neighbours(const TriangleMesh& mesh) {
    const auto edges = edges_of(mesh);
    start.assign(mesh.vertex_count() + 1, 0);
    for (Eigen::Index i = 0; i < edges.size(); ++i) ++start[edges.data()[i] + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    vertex.resize(edges.size()), length.resize(edges.size());
    std::vector<int32_t> at(start.begin(), start.end() - 1);
    for (Eigen::Index e = 0; e < edges.rows(); ++e) {
      const int32_t a = edges(e, 0), b = edges(e, 1);
      const double l = (mesh.positions.row(a) - mesh.positions.row(b)).norm();
      vertex[at[a]] = b, length[at[a]++] = l;
      vertex[at[b]] = a, length[at[b]++] = l;
    }
  }
};

using Start = std::pair<double, int32_t>;  // distance, vertex

// E. Dijkstra, "A Note on Two Problems in Connexion with Graphs", 1959. Visits vertices by growing distance up to limit.
template <class Visit>
void walk(const Neighbours& near, std::vector<Start> starts, double limit, std::map<int32_t, double>& known,
          Visit visit) {
  std::priority_queue<Start, std::vector<Start>, std::greater<>> open;
  const auto reach = [&](double distance, int32_t v) {
    if (distance > limit) return;
    const auto [at, is_new] = known.try_emplace(v, distance);
    if (!is_new && at->second <= distance) return;
    at->second = distance;
    open.emplace(distance, v);
  };
  for (const auto& [distance, v] : starts) reach(distance, v);
  while (!open.empty()) {
    const auto [distance, v] = open.top();
    open.pop();
    if (distance > known[v]) continue;
    visit(v, distance);
    for (int32_t i = near.start[v]; i < near.start[v + 1]; ++i)
      reach(distance + near.length[i], near.vertex[i]);
  }
}

std::vector<Start> starts_of(const TriangleMesh& mesh, const SurfacePoint& from) {
  const Vector3 place = position_of(mesh, from);
  std::vector<Start> starts;
  for (int i = 0; i < 3; ++i) {
    const int32_t v = mesh.triangles(from.triangle, i);
    starts.emplace_back((mesh.positions.row(v).transpose() - place).norm(), v);
  }
  return starts;
}

// Moves landmarks to the kept triangles; one at a vertex survives in any triangle of the vertex.
void keep_marks(std::vector<std::optional<SurfacePoint>>& marks, const MatrixX3i& triangles,
                const std::vector<int32_t>& new_triangle) {
  std::map<int32_t, SurfacePoint> corner;
  for (int32_t t = 0; t < triangles.rows(); ++t)
    for (int i = 0; new_triangle[t] >= 0 && i < 3; ++i)
      corner.try_emplace(triangles(t, i), SurfacePoint{new_triangle[t], Vector3::Unit(i)});
  for (auto& mark : marks) {
    if (!mark) continue;
    Eigen::Index heaviest = 0;
    const bool is_vertex = mark->barycentric.maxCoeff(&heaviest) >= at_corner;
    const int32_t t = mark->triangle;
    mark->triangle = new_triangle[t];
    if (mark->triangle >= 0) continue;
    const auto at = corner.find(triangles(t, heaviest));
    if (is_vertex && at != corner.end())
      mark = at->second;
    else
      mark.reset();
  }
}

std::vector<char> triangles_without(const TriangleMesh& mesh, const std::vector<char>& lost) {
  std::vector<char> stays(mesh.triangle_count());
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    stays[t] = !lost[mesh.triangles(t, 0)] && !lost[mesh.triangles(t, 1)] && !lost[mesh.triangles(t, 2)];
  return stays;
}

using Edge = std::pair<int32_t, int32_t>;

// Directed edges without a triangle on their other side, sorted.
std::vector<Edge> border_of(const TriangleMesh& mesh) {
  std::vector<Edge> directed;
  directed.reserve(static_cast<size_t>(mesh.triangles.size()));
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) directed.emplace_back(mesh.triangles(t, i), mesh.triangles(t, (i + 1) % 3));
  std::sort(directed.begin(), directed.end());
  directed.erase(std::unique(directed.begin(), directed.end()), directed.end());
  std::vector<Edge> border;
  for (const auto& [a, b] : directed)
    if (!std::binary_search(directed.begin(), directed.end(), Edge(b, a))) border.emplace_back(a, b);
  return border;
}

// The connected groups of edges, ordered by their first edge.
std::vector<std::vector<Edge>> groups_of(const std::vector<Edge>& edges, int32_t vertex_count) {
  std::vector<int32_t> group(vertex_count);
  std::iota(group.begin(), group.end(), 0);
  const auto root = [&](int32_t v) {
    while (group[v] != v) v = group[v] = group[group[v]];
    return v;
  };
  for (const auto& [a, b] : edges) group[root(a)] = root(b);
  std::map<int32_t, size_t> number;
  std::vector<std::vector<Edge>> groups;
  for (const auto& edge : edges) {
    const auto [at, is_new] = number.try_emplace(root(edge.first), groups.size());
    if (is_new) groups.emplace_back();
    groups[at->second].push_back(edge);
  }
  return groups;
}

// Adds a fan from the centroid of each new border.
void cap(CorruptedMesh& corrupted, std::vector<Edge> old_border) {
  std::vector<Edge> made;
  for (const auto& [a, b] : border_of(corrupted.mesh)) {
    const Edge was{corrupted.old_vertex[a], corrupted.old_vertex[b]};
    if (!std::binary_search(old_border.begin(), old_border.end(), was)) made.emplace_back(a, b);
  }
  TriangleMesh& mesh = corrupted.mesh;
  for (const auto& loop : groups_of(made, mesh.vertex_count())) {
    Eigen::RowVector3d middle(0, 0, 0);
    for (const auto& edge : loop) middle += mesh.positions.row(edge.first) / static_cast<double>(loop.size());
    const int32_t centre = mesh.vertex_count();
    mesh.positions.conservativeResize(centre + 1, 3);
    mesh.positions.row(centre) = middle;
    corrupted.old_vertex.push_back(-1);
    int32_t t = mesh.triangle_count();
    mesh.triangles.conservativeResize(t + static_cast<int32_t>(loop.size()), 3);
    for (const auto& [a, b] : loop) mesh.triangles.row(t++) << b, a, centre;
    corrupted.old_triangle.resize(t, -1);
  }
}

CorruptedMesh without_crumbs(CorruptedMesh corrupted) {
  const Components parts = components_of(corrupted.mesh);
  std::vector<int32_t> size(parts.count, 0);
  const int32_t count = corrupted.mesh.triangle_count();
  for (int32_t t = 0; t < count; ++t) ++size[parts.of_vertex[corrupted.mesh.triangles(t, 0)]];
  std::vector<char> stays(count);
  for (int32_t t = 0; t < count; ++t)
    stays[t] = size[parts.of_vertex[corrupted.mesh.triangles(t, 0)]] * 100 >= count;
  return keep_triangles(std::move(corrupted), stays);
}

}  // namespace

CorruptedMesh intact(TriangleMesh mesh, std::vector<std::optional<SurfacePoint>> marks) {
  CorruptedMesh result{std::move(mesh), std::move(marks), {}, {}};
  result.old_vertex.resize(result.mesh.vertex_count());
  result.old_triangle.resize(result.mesh.triangle_count());
  std::iota(result.old_vertex.begin(), result.old_vertex.end(), 0);
  std::iota(result.old_triangle.begin(), result.old_triangle.end(), 0);
  return result;
}

CorruptedMesh keep_triangles(CorruptedMesh corrupted, std::span<const char> stays) {
  const TriangleMesh& mesh = corrupted.mesh;
  std::vector<int32_t> new_triangle(mesh.triangle_count(), -1), triangles, vertices;
  std::vector<int32_t> new_vertex(mesh.vertex_count(), -1);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (!stays[t]) continue;
    new_triangle[t] = static_cast<int32_t>(triangles.size());
    triangles.push_back(t);
    for (int i = 0; i < 3; ++i) new_vertex[mesh.triangles(t, i)] = 0;
  }
  for (int32_t v = 0; v < mesh.vertex_count(); ++v)
    if (new_vertex[v] == 0) new_vertex[v] = static_cast<int32_t>(vertices.size()), vertices.push_back(v);
  keep_marks(corrupted.marks, mesh.triangles, new_triangle);
  CorruptedMesh result;
  result.marks = std::move(corrupted.marks);
  result.mesh.positions = mesh.positions(vertices, Eigen::all);
  result.mesh.triangles =
      mesh.triangles(triangles, Eigen::all).unaryExpr([&](int32_t v) { return new_vertex[v]; });
  for (const int32_t v : vertices) result.old_vertex.push_back(corrupted.old_vertex[v]);
  for (const int32_t t : triangles) result.old_triangle.push_back(corrupted.old_triangle[t]);
  return result;
}

CorruptedMesh without_vertices(CorruptedMesh corrupted, const std::vector<char>& lost, CutEnd end,
                               const Execution& execution) {
  std::vector<Edge> old_border;
  if (end == CutEnd::capped)
    for (const auto& [a, b] : border_of(corrupted.mesh))
      old_border.emplace_back(corrupted.old_vertex[a], corrupted.old_vertex[b]);
  std::sort(old_border.begin(), old_border.end());
  execution.check_cancelled();
  const std::vector<char> stays = triangles_without(corrupted.mesh, lost);
  corrupted = keep_triangles(std::move(corrupted), stays);
  execution.check_cancelled();
  if (end == CutEnd::capped) cap(corrupted, std::move(old_border));
  return corrupted;
}

CorruptedMesh with_noise(CorruptedMesh corrupted, double share, Random& random) {
  const double deviation = share * mean_edge_length(corrupted.mesh);
  auto& positions = corrupted.mesh.positions;
  for (Eigen::Index i = 0; i < positions.size(); ++i) positions.data()[i] += deviation * random.normal();
  return corrupted;
}

CorruptedMesh with_holes(CorruptedMesh corrupted, int32_t count, double radius, Random& random) {
  const TriangleMesh& mesh = corrupted.mesh;
  const Neighbours near(mesh);
  const double limit = radius * mean_edge_length(mesh);
  std::vector<char> lost(mesh.vertex_count(), 0);
  for (const int32_t v : sample_without_replacement(random, mesh.vertex_count(), count)) {
    std::map<int32_t, double> known;
    walk(near, {{0, v}}, limit, known, [&](int32_t reached, double) { lost[reached] = 1; });
  }
  const std::vector<char> stays = triangles_without(mesh, lost);
  return keep_triangles(std::move(corrupted), stays);
}

CorruptedMesh cut_ball(CorruptedMesh corrupted, const SurfacePoint& centre, double radius, CutEnd end,
                       const Execution& execution) {
  const Vector lengths = edge_path_lengths(corrupted.mesh, centre, radius);
  std::vector<char> lost(corrupted.mesh.vertex_count());
  for (size_t v = 0; v < lost.size(); ++v) lost[v] = lengths[static_cast<Eigen::Index>(v)] < radius;
  execution.check_cancelled();
  corrupted = without_vertices(std::move(corrupted), lost, end, execution);
  execution.check_cancelled();
  return without_crumbs(std::move(corrupted));
}

Vector edge_path_lengths(const TriangleMesh& mesh, const SurfacePoint& from, double limit) {
  Vector lengths = Vector::Constant(mesh.vertex_count(), infinity);
  std::map<int32_t, double> known;
  walk(Neighbours(mesh), starts_of(mesh, from), limit, known,
       [&](int32_t v, double distance) { lengths[v] = distance; });
  return lengths;
}

}  // namespace focal
