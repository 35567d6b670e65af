#include "mesh/fill_holes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mesh/components.h"
#include "mesh/edges.h"
#include "mesh/hole_patch.h"

namespace focal {
namespace {

struct BorderEdge {
  int32_t from = 0, to = 0;  // in the direction of the hole: opposite to its triangle's
};

// Edges of exactly one triangle, sorted by `from`.
std::vector<BorderEdge> border_edges(const TriangleMesh& mesh) {
  const EdgeSides edges = edge_sides(mesh);
  std::vector<BorderEdge> border;
  for (int32_t e = 0; e < edges.edge_count(); ++e)
    if (const auto sides = edges.of_edge(e); sides.size() == 1)
      border.push_back({side_to(mesh.triangles, sides[0]), side_from(mesh.triangles, sides[0])});
  std::sort(border.begin(), border.end(), [](const BorderEdge& x, const BorderEdge& y) {
    return std::pair(x.from, x.to) < std::pair(y.from, y.to);
  });
  return border;
}

// Follows unused edges; where the path meets itself, a simple loop is split off. Paths that end are not
// loops.
std::vector<std::vector<int32_t>> loops_of(const std::vector<BorderEdge>& border, int32_t vertex_count) {
  std::vector<std::vector<int32_t>> loops;
  std::vector<char> used(border.size(), 0);
  std::vector<int32_t> at_step(vertex_count, -1);  // step of the path at which a vertex was visited
  const auto unused_from = [&](int32_t v) {
    auto e = std::lower_bound(border.begin(), border.end(), v,
                              [](const BorderEdge& x, int32_t from) { return x.from < from; });
    while (e != border.end() && e->from == v && used[e - border.begin()]) ++e;
    return e != border.end() && e->from == v ? e - border.begin() : std::ptrdiff_t{-1};
  };
  for (size_t first = 0; first < border.size(); ++first) {
    if (used[first]) continue;
    std::vector<int32_t> way{border[first].from};
    at_step[way[0]] = 0;
    for (std::ptrdiff_t e; (e = unused_from(way.back())) >= 0;) {
      used[e] = 1;
      const int32_t v = border[e].to;
      if (at_step[v] < 0) {
        at_step[v] = static_cast<int32_t>(way.size());
        way.push_back(v);
        continue;
      }
      loops.emplace_back(way.begin() + at_step[v], way.end());
      for (auto w = way.begin() + at_step[v] + 1; w != way.end(); ++w) at_step[*w] = -1;
      way.resize(at_step[v] + 1);
    }
    for (const int32_t v : way) at_step[v] = -1;
  }
  return loops;
}

double length_of(const TriangleMesh& mesh, const std::vector<int32_t>& loop) {
  double length = 0;
  for (size_t i = 0; i < loop.size(); ++i)
    length += (mesh.positions.row(loop[i]) - mesh.positions.row(loop[(i + 1) % loop.size()])).norm();
  return length;
}

// The triangles at the vertices of some loops.
class Surroundings {
 public:
  Surroundings(const TriangleMesh& mesh, const std::vector<std::vector<int32_t>>& loops)
      : mesh_(mesh), slot_(mesh.vertex_count(), -1) {
    for (const auto& loop : loops)
      for (const int32_t v : loop)
        if (slot_[v] < 0) slot_[v] = static_cast<int32_t>(triangles_.size()), triangles_.emplace_back();
    for (int32_t t = 0; t < mesh.triangle_count(); ++t)
      for (int i = 0; i < 3; ++i)
        if (const int32_t slot = slot_[mesh.triangles(t, i)]; slot >= 0) triangles_[slot].push_back(t);
  }

  HoleLoop loop_of(const std::vector<int32_t>& loop) const {
    HoleLoop result;
    const auto n = static_cast<int32_t>(loop.size());
    Numbers number;
    for (int32_t i = 0; i < n; ++i) number.emplace_back(loop[i], i);
    std::sort(number.begin(), number.end());
    for (int32_t i = 0; i < n; ++i) add_vertex(loop, i, number, result);
    return result;
  }

  // Patches of holes that share vertices must not use the same edge.
  void remember(const HolePatch& patch, const std::vector<int32_t>& loop) {
    const auto n = static_cast<int32_t>(loop.size());
    for (const auto& corners : patch.triangles)
      for (int i = 0; i < 3; ++i) {
        const int32_t a = corners[i], b = corners[(i + 1) % 3];
        if (a < n && b < n) joined_[loop[a]].insert(loop[b]), joined_[loop[b]].insert(loop[a]);
      }
  }

 private:
  // Vertex numbers in the mesh and in the loop.
  using Numbers = std::vector<std::pair<int32_t, int32_t>>;

  static void take(int32_t i, int32_t w, const Numbers& number, HoleLoop& result) {
    const auto at = std::lower_bound(number.begin(), number.end(), std::pair(w, -1));
    if (at != number.end() && at->first == w) result.taken.insert(std::minmax(i, at->second));
  }

  void add_vertex(const std::vector<int32_t>& loop, int32_t i, const Numbers& number,
                  HoleLoop& result) const {
    const auto n = static_cast<int32_t>(loop.size());
    const int32_t v = loop[i], next = loop[(i + 1) % n];
    const Vector3 place = mesh_.positions.row(v);
    std::set<int32_t> near;
    Vector3 normal = Vector3::Zero(), sum = Vector3::Zero();
    double length = 0;
    for (const int32_t t : triangles_[slot_[v]]) {
      const auto corners = mesh_.triangles.row(t);
      near.insert({corners[0], corners[1], corners[2]});
      const Vector3 a = mesh_.positions.row(corners[0]), b = mesh_.positions.row(corners[1]),
                    c = mesh_.positions.row(corners[2]);
      if ((corners.array() == next).any()) normal = (b - a).cross(c - a).normalized();
    }
    near.erase(v);
    for (const int32_t w : near) {
      sum += mesh_.positions.row(w);
      length += (mesh_.positions.row(w).transpose() - place).norm();
      take(i, w, number, result);
    }
    if (const auto by_patches = joined_.find(v); by_patches != joined_.end())
      for (const int32_t w : by_patches->second) take(i, w, number, result);
    result.positions.push_back(place);
    result.outer_normal.push_back(normal);
    result.outer_sum.push_back(sum);
    result.outer_count.push_back(static_cast<int32_t>(near.size()));
    result.density.push_back(length / static_cast<double>(near.size()));
  }

  const TriangleMesh& mesh_;
  std::vector<int32_t> slot_;
  std::vector<std::vector<int32_t>> triangles_;
  std::map<int32_t, std::set<int32_t>> joined_;
};

struct Additions {
  std::vector<Vector3> vertices;
  std::vector<std::array<int32_t, 3>> triangles;
};

// Converts the loop's vertex numbers to those of the mesh.
void add_patch(const HolePatch& patch, const std::vector<int32_t>& loop, int32_t mesh_vertices,
               Additions& added) {
  const auto n = static_cast<int32_t>(loop.size());
  const auto base = mesh_vertices + static_cast<int32_t>(added.vertices.size());
  for (auto triangle : patch.triangles) {
    for (int32_t& v : triangle) v = v < n ? loop[v] : base + v - n;
    added.triangles.push_back(triangle);
  }
  added.vertices.insert(added.vertices.end(), patch.inner.begin(), patch.inner.end());
}

double area_of(const HolePatch& patch, const HoleLoop& loop) {
  const auto at = [&](int32_t v) {
    const auto n = static_cast<int32_t>(loop.positions.size());
    return v < n ? loop.positions[v] : patch.inner[v - n];
  };
  double area = 0;
  for (const auto& [a, b, c] : patch.triangles) area += (at(b) - at(a)).cross(at(c) - at(a)).norm() / 2;
  return area;
}

std::vector<double> area_of_parts(const TriangleMesh& mesh, const Components& parts) {
  std::vector<double> area(parts.count, 0);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto at = [&](int i) -> Vector3 { return mesh.positions.row(mesh.triangles(t, i)); };
    area[parts.of_vertex[mesh.triangles(t, 0)]] += (at(1) - at(0)).cross(at(2) - at(0)).norm() / 2;
  }
  return area;
}

void append(TriangleMesh& mesh, const Additions& added) {
  const int32_t vertices = mesh.vertex_count(), triangles = mesh.triangle_count();
  mesh.positions.conservativeResize(vertices + static_cast<int32_t>(added.vertices.size()), 3);
  for (size_t v = 0; v < added.vertices.size(); ++v)
    mesh.positions.row(vertices + static_cast<int32_t>(v)) = added.vertices[v];
  mesh.triangles.conservativeResize(triangles + static_cast<int32_t>(added.triangles.size()), 3);
  for (size_t t = 0; t < added.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      mesh.triangles(triangles + static_cast<int32_t>(t), i) = added.triangles[t][i];
}

}  // namespace

std::vector<std::vector<int32_t>> border_loops(const TriangleMesh& mesh) {
  return loops_of(border_edges(mesh), mesh.vertex_count());
}

FilledMesh fill_holes(const TriangleMesh& mesh, const FillParams& params) {
  auto loops = border_loops(mesh);
  const double longest = loops.empty() ? 0 : params.longest_border * std::sqrt(surface_area(mesh));
  std::erase_if(loops, [&](const auto& loop) { return loop.size() < 3 || length_of(mesh, loop) > longest; });
  FilledMesh result;
  if (loops.empty()) return result;
  Surroundings surroundings(mesh, loops);
  const Components parts = components_of(mesh);
  const std::vector<double> area = area_of_parts(mesh, parts);
  Additions added;
  for (const auto& loop : loops) {
    const HoleLoop around = surroundings.loop_of(loop);
    const HolePatch patch = patch_hole(around);
    const double largest = params.largest_share * area[parts.of_vertex[loop[0]]];
    if (patch.triangles.empty() || area_of(patch, around) > largest) continue;
    add_patch(patch, loop, mesh.vertex_count(), added);
    surroundings.remember(patch, loop);
    ++result.holes;
  }
  if (result.holes > 0) result.mesh = mesh, append(result.mesh, added);
  return result;
}

}  // namespace focal
