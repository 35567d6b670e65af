#include "mesh/topology.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace focal {
namespace {

constexpr double negligible_share = 0.01;   // of the area that may be in one-sided patches
constexpr double negligible_volume = 1e-6;  // of area^1.5: two sheets back to back enclose nothing

class UnionFind {
 public:
  explicit UnionFind(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int32_t root(int32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int32_t a, int32_t b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int32_t> parent_;
};

// Corner 3 t + i of triangle t at the end where its side begins, and at the other.
int32_t corner_from(int32_t side) { return side - side % 3 + (side + 1) % 3; }
int32_t corner_to(int32_t side) { return side - side % 3 + (side + 2) % 3; }

// Corners connected by the edges at them: the roots are the triangle fans around the vertices.
UnionFind fans_of(const MatrixX3i& triangles, const EdgeSides& edges) {
  UnionFind fans(static_cast<size_t>(triangles.size()));
  for (int32_t e = 0; e < edges.edge_count(); ++e) {
    const auto sides = edges.of_edge(e);
    for (const int32_t other : sides.subspan(1)) {
      const bool same = side_from(triangles, sides[0]) == side_from(triangles, other);
      fans.join(corner_from(sides[0]), same ? corner_from(other) : corner_to(other));
      fans.join(corner_to(sides[0]), same ? corner_to(other) : corner_from(other));
    }
  }
  return fans;
}

int64_t vertices_of_several_fans(const TriangleMesh& mesh, UnionFind& fans) {
  std::vector<char> fans_at(mesh.vertex_count(), 0);  // 0, 1 or several
  int64_t count = 0;
  for (int32_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
    if (fans.root(corner) != corner) continue;
    char& here = fans_at[mesh.triangles(corner / 3, corner % 3)];
    count += here == 1;
    if (here < 2) ++here;
  }
  return count;
}

// Boundary edges, connected through the fans that they bound.
int64_t count_loops(const EdgeSides& edges, UnionFind& fans) {
  std::vector<int32_t> border;
  for (int32_t e = 0; e < edges.edge_count(); ++e)
    if (const auto sides = edges.of_edge(e); sides.size() == 1) border.push_back(sides[0]);
  for (const int32_t side : border) fans.join(corner_from(side), corner_to(side));
  std::vector<int32_t> loops;
  for (const int32_t side : border) loops.push_back(fans.root(corner_from(side)));
  std::sort(loops.begin(), loops.end());
  return std::unique(loops.begin(), loops.end()) - loops.begin();
}

struct Patch {
  bool is_closed = true, is_one_sided = false;
  int64_t triangles = 0, reversed = 0;
  double area = 0, volume = 0;

  bool is_turned_over() const {  // as a whole, once its triangles are consistent
    const double enclosed = is_closed ? volume : 0;
    if (std::abs(enclosed) > negligible_volume * std::pow(area, 1.5)) return enclosed < 0;
    return 2 * reversed > triangles;
  }
};

class Orienter {
 public:
  Orienter(const TriangleMesh& mesh, const EdgeSides& edges)
      : mesh_(mesh),
        edges_(edges),
        twin_(static_cast<size_t>(mesh.triangles.size()), -1),
        patch_of_(mesh.triangle_count(), -1),
        reversed_(mesh.triangle_count(), 0) {
    for (int32_t e = 0; e < edges.edge_count(); ++e)
      if (const auto sides = edges.of_edge(e); sides.size() == 2)
        twin_[sides[0]] = sides[1], twin_[sides[1]] = sides[0];
  }

  Orientation run() {
    for (int32_t t = 0; t < mesh_.triangle_count(); ++t)
      if (patch_of_[t] < 0) flood(t);
    find_open_patches();
    for (int32_t t = 0; t < mesh_.triangle_count(); ++t) measure(t);
    return result();
  }

 private:
  void flood(int32_t first) {
    const auto number = static_cast<int32_t>(patches_.size());
    Patch& patch = patches_.emplace_back();
    std::vector<int32_t> queue = {first};
    patch_of_[first] = number;
    while (!queue.empty()) {
      const int32_t t = queue.back();
      queue.pop_back();
      for (int32_t side = 3 * t; side < 3 * t + 3; ++side) {
        if (twin_[side] < 0) continue;
        const int32_t other = twin_[side] / 3;
        const bool agree = side_from(mesh_.triangles, side) != side_from(mesh_.triangles, twin_[side]);
        const char reversed = agree ? reversed_[t] : !reversed_[t];
        if (patch_of_[other] >= 0) {
          patch.is_one_sided = patch.is_one_sided || reversed_[other] != reversed;
          continue;
        }
        patch_of_[other] = number, reversed_[other] = reversed;
        queue.push_back(other);
      }
    }
  }

  // Closed: every edge has as many triangles in one direction as in the other.
  void find_open_patches() {
    const auto direction = [&](int32_t side) {
      const bool up = side_from(mesh_.triangles, side) < side_to(mesh_.triangles, side);
      return up != (reversed_[side / 3] != 0) ? 1 : -1;
    };
    std::vector<int32_t> sum(patches_.size(), 0);
    for (int32_t e = 0; e < edges_.edge_count(); ++e) {
      const auto sides = edges_.of_edge(e);
      if (sides.size() == 2) continue;
      for (const int32_t side : sides) sum[patch_of_[side / 3]] += direction(side);
      for (const int32_t side : sides) {
        const int32_t patch = patch_of_[side / 3];
        if (sum[patch] != 0) patches_[patch].is_closed = false;
      }
      for (const int32_t side : sides) sum[patch_of_[side / 3]] = 0;
    }
  }

  void measure(int32_t t) {
    const auto at = [&](int i) -> Vector3 { return mesh_.positions.row(mesh_.triangles(t, i)); };
    const Vector3 cross = (at(1) - at(0)).cross(at(2) - at(0));
    Patch& patch = patches_[patch_of_[t]];
    ++patch.triangles, patch.reversed += reversed_[t];
    patch.area += cross.norm() / 2;
    patch.volume += (reversed_[t] ? -1 : 1) * at(0).dot(cross) / 6;
  }

  Orientation result() {
    Orientation result;
    double area = 0, one_sided = 0;
    std::vector<char> over;
    for (const Patch& patch : patches_) {
      area += patch.area, one_sided += patch.is_one_sided ? patch.area : 0;
      over.push_back(patch.is_turned_over());
    }
    result.is_consistent = one_sided <= negligible_share * area;
    result.flipped = std::move(reversed_);
    for (int32_t t = 0; t < mesh_.triangle_count(); ++t) {
      const int32_t patch = patch_of_[t];
      result.flipped[t] = !patches_[patch].is_one_sided && result.flipped[t] != over[patch];
      result.flips += result.flipped[t];
    }
    return result;
  }

  const TriangleMesh& mesh_;
  const EdgeSides& edges_;
  std::vector<int32_t> twin_, patch_of_;
  std::vector<char> reversed_;  // relative to the first triangle of its patch
  std::vector<Patch> patches_;
};

}  // namespace

Topology topology_of(const TriangleMesh& mesh, const EdgeSides& edges) {
  Topology result;
  for (int32_t e = 0; e < edges.edge_count(); ++e) result.nonmanifold_edges += edges.of_edge(e).size() > 2;
  UnionFind fans = fans_of(mesh.triangles, edges);
  result.nonmanifold_vertices = vertices_of_several_fans(mesh, fans);
  result.boundary_loops = count_loops(edges, fans);
  return result;
}

Orientation consistent_orientation(const TriangleMesh& mesh, const EdgeSides& edges) {
  return Orienter(mesh, edges).run();
}

}  // namespace focal
