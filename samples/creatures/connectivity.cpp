// A closed triangle mesh that can be changed edge by edge and stays closed and manifold.
#include "connectivity.h"

#include <algorithm>

namespace creatures {

Connectivity::Connectivity(const Mesh& mesh)
    : positions(mesh.positions), triangles_(mesh.triangles), fans_(mesh.positions.size()) {
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) attach(t);
}

void Connectivity::attach(int triangle) {
  for (int v : triangles_[triangle]) fans_[v].push_back(triangle);
}

void Connectivity::detach(int triangle) {
  for (int v : triangles_[triangle]) std::erase(fans_[v], triangle);
}

std::vector<int> Connectivity::neighbours(int vertex) const {
  std::vector<int> ring;
  for (int t : fans_[vertex])
    for (int k = 0; k < 3; ++k)
      if (triangles_[t][k] == vertex) ring.push_back(triangles_[t][(k + 1) % 3]);
  return ring;
}

std::vector<std::pair<int, int>> Connectivity::edges() const {
  std::vector<std::pair<int, int>> all;
  for (int v = 0; v < static_cast<int>(fans_.size()); ++v)
    for (int w : neighbours(v))
      if (v < w) all.emplace_back(v, w);
  std::sort(all.begin(), all.end());
  return all;
}

int Connectivity::triangle_with(int a, int b) const {
  for (int t : fans_[a])
    for (int k = 0; k < 3; ++k)
      if (triangles_[t][k] == a && triangles_[t][(k + 1) % 3] == b) return t;
  return -1;
}

bool Connectivity::is_edge(int a, int b) const { return triangle_with(a, b) >= 0; }

std::pair<int, int> Connectivity::opposite(int a, int b) const {
  const auto third = [&](int t) {
    for (int v : triangles_[t])
      if (v != a && v != b) return v;
    return -1;
  };
  return {third(triangle_with(a, b)), third(triangle_with(b, a))};
}

Vec3 Connectivity::face_normal(const Triangle& t) const {
  return (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]);
}

Vec3 Connectivity::normal(int vertex) const {
  Vec3 sum = Vec3::Zero();
  for (int t : fans_[vertex]) sum += face_normal(triangles_[t]);
  return sum;
}

int Connectivity::split(int a, int b, const Vec3& at) {
  const int fresh = static_cast<int>(positions.size());
  positions.push_back(at);
  fans_.emplace_back();
  for (int side : {triangle_with(a, b), triangle_with(b, a)}) {
    detach(side);
    Triangle half = triangles_[side];
    std::replace(half.begin(), half.end(), a, fresh);
    std::replace(triangles_[side].begin(), triangles_[side].end(), b, fresh);
    attach(side);
    triangles_.push_back(half);
    attach(static_cast<int>(triangles_.size()) - 1);
  }
  return fresh;
}

// Whether moving `vertex` turns a triangle around it by more than about 70 degrees; those with `except` vanish.
bool Connectivity::turns_over(int vertex, const Vec3& at, int except) const {
  for (int t : fans_[vertex]) {
    const Triangle& old = triangles_[t];
    if (std::find(old.begin(), old.end(), except) != old.end()) continue;
    std::array<Vec3, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = old[k] == vertex ? at : positions[old[k]];
    const Vec3 before = face_normal(old), after = (p[1] - p[0]).cross(p[2] - p[0]);
    if (after.dot(before) < 0.35 * after.norm() * before.norm()) return true;
  }
  return false;
}

bool Connectivity::collapse(int a, int b, const Vec3& at) {
  // Link condition (Dey et al., "Topology preserving edge contraction", 1999): only the two opposite vertices
  // are neighbours of both, and they keep a valence of three.
  const auto [left, right] = opposite(a, b);
  int common = 0;
  for (int v : neighbours(a)) common += is_edge(v, b);
  if (common != 2 || valence(left) < 4 || valence(right) < 4) return false;
  if (turns_over(a, at, b) || turns_over(b, at, a)) return false;
  for (int t : {triangle_with(a, b), triangle_with(b, a)}) {
    detach(t);
    triangles_[t] = {-1, -1, -1};
  }
  for (int t : fans_[b]) {
    std::replace(triangles_[t].begin(), triangles_[t].end(), b, a);
    fans_[a].push_back(t);
  }
  fans_[b].clear();
  positions[a] = at;
  return true;
}

bool Connectivity::move(int vertex, const Vec3& to) {
  if (turns_over(vertex, to, -1)) return false;
  positions[vertex] = to;
  return true;
}

bool Connectivity::flip(int a, int b) {
  const auto [left, right] = opposite(a, b);
  if (valence(a) < 4 || valence(b) < 4 || is_edge(left, right)) return false;
  const int first = triangle_with(a, b), second = triangle_with(b, a);
  const Triangle one{left, right, b}, two{right, left, a};
  const Vec3 before = face_normal(triangles_[first]) + face_normal(triangles_[second]);
  for (const Triangle& t : {one, two}) {
    const Vec3 n = face_normal(t);
    if (n.dot(before) < 0.7 * n.norm() * before.norm()) return false;
  }
  detach(first);
  detach(second);
  triangles_[first] = one;
  triangles_[second] = two;
  attach(first);
  attach(second);
  return true;
}

Mesh Connectivity::compact() const {
  Mesh mesh;
  std::vector<int> renumbered(positions.size(), -1);
  for (size_t v = 0; v < positions.size(); ++v)
    if (alive(static_cast<int>(v))) {
      renumbered[v] = static_cast<int>(mesh.positions.size());
      mesh.positions.push_back(positions[v]);
    }
  for (const Triangle& t : triangles_)
    if (t[0] >= 0) mesh.triangles.push_back({renumbered[t[0]], renumbered[t[1]], renumbered[t[2]]});
  return mesh;
}

}  // namespace creatures
