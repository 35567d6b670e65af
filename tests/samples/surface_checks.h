// Independent checks of triangle surfaces, for the tests of the sample characters.
#pragma once
#include <algorithm>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "creatures/geometry.h"

namespace creatures::checks {

struct Topology {
  bool closed_and_oriented = true;  // every directed edge once, and once the other way
  bool fans_whole = true;           // the triangles around each vertex form one ring
  int components = 0;
  int euler = 0;
};

inline Topology topology(const Mesh& mesh) {
  const int count = static_cast<int>(mesh.positions.size());
  Topology found;
  std::map<std::pair<int, int>, int> next;  // directed edge a -> b of a triangle a b c, to c
  std::vector<int> root(count), valence(count, 0), start(count, -1);
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      found.closed_and_oriented &= next.emplace(std::pair{t[k], t[(k + 1) % 3]}, t[(k + 2) % 3]).second;
      ++valence[t[k]];
      start[t[k]] = t[(k + 1) % 3];
      root[find(t[k])] = find(t[(k + 1) % 3]);
    }
  for (const auto& [edge, opposite] : next)
    found.closed_and_oriented &= next.contains({edge.second, edge.first});
  if (!found.closed_and_oriented) return found;
  for (int v = 0; v < count; ++v) {
    found.components += find(v) == v;
    int steps = 0, at = start[v];
    do at = at < 0 ? -1 : next.at({v, at});
    while (++steps <= valence[v] && at != start[v]);
    found.fans_whole &= valence[v] >= 3 && steps == valence[v];
  }
  found.euler = count - static_cast<int>(next.size()) / 2 + static_cast<int>(mesh.triangles.size());
  return found;
}

inline double volume(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6;
  return sum;
}

inline bool segment_crosses(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& t) {
  const auto side = [](const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    return (q - p).cross(r - p).dot(s - p) > 0;
  };
  if (side(t[0], t[1], t[2], a) == side(t[0], t[1], t[2], b)) return false;
  const bool first = side(a, b, t[0], t[1]);
  return first == side(a, b, t[1], t[2]) && first == side(a, b, t[2], t[0]);
}

// Pairs of triangles that cross each other and share no edge.
inline int self_intersections(const Mesh& mesh) {
  struct Box {
    Eigen::AlignedBox3d box;
    int triangle;
  };
  std::vector<Box> boxes;
  const auto corners = [&](int t) {
    std::array<Vec3, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = mesh.positions[mesh.triangles[t][k]];
    return p;
  };
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    boxes.push_back({{}, t});
    for (const Vec3& p : corners(t)) boxes.back().box.extend(p);
  }
  std::sort(boxes.begin(), boxes.end(),
            [](const Box& a, const Box& b) { return a.box.min().y() < b.box.min().y(); });
  // Edges of one triangle that touch no corner of the other, against the other.
  const auto crosses = [&](int s, int t) {
    const Triangle &a = mesh.triangles[s], &b = mesh.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const int from = a[k], to = a[(k + 1) % 3];
      if (std::find(b.begin(), b.end(), from) != b.end() || std::find(b.begin(), b.end(), to) != b.end())
        continue;
      if (segment_crosses(mesh.positions[from], mesh.positions[to], corners(t))) return true;
    }
    return false;
  };
  int found = 0;
  for (size_t i = 0; i < boxes.size(); ++i)
    for (size_t j = i + 1; j < boxes.size() && boxes[j].box.min().y() <= boxes[i].box.max().y(); ++j)
      if (boxes[i].box.intersects(boxes[j].box))
        found +=
            crosses(boxes[i].triangle, boxes[j].triangle) || crosses(boxes[j].triangle, boxes[i].triangle);
  return found;
}

}  // namespace creatures::checks
