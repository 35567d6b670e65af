// P. Liepa, "Filling Holes in Meshes", 2003: triangulation of least bending, then of least area (after G. Barequet,
// M. Sharir, "Filling Gaps in the Boundary of a Polyhedron", 1995); refinement (after R. Pfeifle, H.-P. Seidel,
// "Triangular B-Splines for Blending and Filling of Polygonal Holes", 1996); fairing by the second-order umbrella
// operator (L. Kobbelt et al., "Interactive Multi-Resolution Modeling on Arbitrary Meshes", 1998).
#include "mesh/hole_patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace focal {
namespace {

// Longer loops are split in two first: the triangulation takes n^3 steps.
constexpr int32_t largest_polygon = 120;
constexpr size_t max_inner = 300;        // the fairing solves a dense system of this size
constexpr int max_rounds = 12;           // of refinement; each shortens edges by a third
constexpr double stump_alignment = 0.5;  // mean cosine between the surface around a hole and the hole

using Triangle = std::array<int32_t, 3>;
using Edge = std::pair<int32_t, int32_t>;

Vector3 normal_of(const Vector3& a, const Vector3& b, const Vector3& c) { return (b - a).cross(c - a); }

// Bending first, area second. Sharp: two triangles folded onto each other, or a diagonal that is already an
// edge of the surface.
struct Weight {
  double bending = 0, area = 0;
  bool operator<(const Weight& other) const {
    return bending != other.bending ? bending < other.bending : area < other.area;
  }
};
constexpr Weight impossible{std::numeric_limits<double>::infinity(), 0};

double bending_between(const Vector3& a,
                       const Vector3& b) {  // 0 flat .. 2 folded; rounded, so that area decides ties
  const double lengths = a.norm() * b.norm();
  return lengths > 0 ? std::round((1 - a.dot(b) / lengths) * 64) / 64 : 0;
}

// Minimum-weight triangulation of a polygon of loop vertices.
class Polygon {
 public:
  Polygon(const HoleLoop& loop, std::vector<int32_t> corners)
      : loop_(loop),
        corners_(std::move(corners)),
        n_(static_cast<int32_t>(corners_.size())),
        weight_(static_cast<size_t>(n_) * n_),
        apex_(weight_.size(), -1) {}

  bool triangulate(std::vector<Triangle>& triangles) {
    for (int32_t span = 2; span < n_; ++span)
      for (int32_t i = 0; i + span < n_; ++i) choose(i, i + span);
    if (!(at(weight_, 0, n_ - 1) < impossible)) return false;
    collect(0, n_ - 1, triangles);
    return true;
  }

 private:
  template <class T>
  T& at(std::vector<T>& table, int32_t i, int32_t k) const {
    return table[static_cast<size_t>(i) * n_ + k];
  }
  const Vector3& place(int32_t i) const { return loop_.positions[corners_[i]]; }

  bool is_free(int32_t i, int32_t k) const {
    if (k == i + 1 || (i == 0 && k == n_ - 1)) return true;  // a side of the polygon
    return !loop_.taken.contains(std::minmax(corners_[i], corners_[k]));
  }

  // Normal of the triangle across the side or diagonal from i to k; zero: unknown.
  Vector3 across(int32_t i, int32_t k) {
    if (k == i + 1 || (i == 0 && k == n_ - 1)) {
      const int32_t from = k == i + 1 ? corners_[i] : corners_[k],
                    to = k == i + 1 ? corners_[k] : corners_[i];
      const bool is_rim = to == (from + 1) % static_cast<int32_t>(loop_.positions.size());
      return is_rim ? loop_.outer_normal[from] : Vector3(Vector3::Zero());
    }
    return normal_of(place(i), place(at(apex_, i, k)), place(k));
  }

  void choose(int32_t i, int32_t k) {
    Weight best = impossible;
    for (int32_t m = i + 1; is_free(i, k) && m < k; ++m) {
      const Weight &left = at(weight_, i, m), &right = at(weight_, m, k);
      if (!(left < impossible) || !(right < impossible)) continue;
      const Vector3 normal = normal_of(place(i), place(m), place(k));
      double bending = std::max({left.bending, right.bending, bending_between(normal, across(i, m)),
                                 bending_between(normal, across(m, k))});
      if (i == 0 && k == n_ - 1) bending = std::max(bending, bending_between(normal, across(0, n_ - 1)));
      const Weight weight{bending, left.area + right.area + normal.norm() / 2};
      if (weight < best) best = weight, at(apex_, i, k) = m;
    }
    at(weight_, i, k) = best;
  }

  void collect(int32_t i, int32_t k, std::vector<Triangle>& triangles) {
    if (k < i + 2) return;
    const int32_t m = at(apex_, i, k);
    triangles.push_back({corners_[i], corners_[m], corners_[k]});
    collect(i, m, triangles);
    collect(m, k, triangles);
  }

  const HoleLoop& loop_;
  std::vector<int32_t> corners_;
  int32_t n_;
  std::vector<Weight> weight_;
  std::vector<int32_t> apex_;
};

// The shortest chord that leaves a third of the corners on each side.
Edge shortest_chord(const HoleLoop& loop, const std::vector<int32_t>& corners) {
  const auto n = static_cast<int32_t>(corners.size());
  Edge best{-1, -1};
  double shortest = std::numeric_limits<double>::infinity();
  for (int32_t i = 0; i < n; ++i)
    for (int32_t k = i + n / 3; k < std::min(n, i + n - n / 3); ++k) {
      const double length = (loop.positions[corners[i]] - loop.positions[corners[k]]).squaredNorm();
      if (length < shortest && !loop.taken.contains(std::minmax(corners[i], corners[k])))
        shortest = length, best = {i, k};
    }
  return best;
}

bool triangulate(const HoleLoop& loop, std::vector<int32_t> corners, std::vector<Triangle>& triangles) {
  std::vector<std::vector<int32_t>> open{std::move(corners)};
  while (!open.empty()) {
    std::vector<int32_t> polygon = std::move(open.back());
    open.pop_back();
    if (static_cast<int32_t>(polygon.size()) <= largest_polygon) {
      if (!Polygon(loop, std::move(polygon)).triangulate(triangles)) return false;
      continue;
    }
    const auto [i, k] = shortest_chord(loop, polygon);
    if (i < 0) return false;
    std::vector<int32_t> rest(polygon.begin() + k, polygon.end());
    rest.insert(rest.end(), polygon.begin(), polygon.begin() + i + 1);
    open.push_back(std::move(rest));
    open.emplace_back(polygon.begin() + i, polygon.begin() + k + 1);
  }
  return true;
}

// The patch during its construction.
struct Patch {
  const HoleLoop& loop;
  std::vector<Vector3> positions;
  std::vector<double> density;
  std::vector<Triangle> triangles;

  bool split_large();
  bool flip_edges();
  void fair(bool is_smooth);
};

// Inserts a vertex in the middle of each triangle that is much larger than the edges at its corners.
bool Patch::split_large() {
  bool any = false;
  const size_t count = triangles.size();
  for (size_t t = 0; t < count; ++t) {
    if (positions.size() - loop.positions.size() >= max_inner) break;
    const auto [a, b, c] = triangles[t];
    const Vector3 middle = (positions[a] + positions[b] + positions[c]) / 3;
    const double wanted = (density[a] + density[b] + density[c]) / 3;
    const auto is_far = [&](int32_t v) {
      const double distance = std::sqrt(2) * (middle - positions[v]).norm();
      return distance > wanted && distance > density[v];
    };
    if (!is_far(a) || !is_far(b) || !is_far(c)) continue;
    const auto v = static_cast<int32_t>(positions.size());
    positions.push_back(middle);
    density.push_back(wanted);
    triangles[t] = {a, b, v};
    triangles.push_back({b, c, v});
    triangles.push_back({c, a, v});
    any = true;
  }
  return any;
}

double corner_angle(const Vector3& at, const Vector3& a, const Vector3& b) {
  return std::atan2((a - at).cross(b - at).norm(), (a - at).dot(b - at));
}

// Flips edges towards the Delaunay triangulation: the angles opposite to an edge sum to at most 180 degrees.
// A sweep flips each triangle at most once.
bool Patch::flip_edges() {
  std::map<Edge, std::array<int32_t, 2>> sides;  // the triangles at an edge
  for (size_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto [at, is_new] = sides.try_emplace(std::minmax(triangles[t][i], triangles[t][(i + 1) % 3]),
                                                  std::array<int32_t, 2>{-1, -1});
      at->second[is_new ? 0 : 1] = static_cast<int32_t>(t);
    }
  std::vector<char> turned(triangles.size(), 0);
  std::set<Edge> added;
  for (const auto& side : sides) {
    const Edge& edge = side.first;
    const auto [t, s] = side.second;
    if (s < 0 || turned[t] || turned[s]) continue;
    const auto opposite = [&](int32_t triangle) {
      for (const int32_t v : triangles[triangle])
        if (v != edge.first && v != edge.second) return v;
      return -1;
    };
    const int32_t p = opposite(t), q = opposite(s);
    const Edge flipped = std::minmax(p, q);
    if (p == q || sides.contains(flipped) || loop.taken.contains(flipped) || added.contains(flipped))
      continue;
    const Vector3 &a = positions[edge.first], &b = positions[edge.second];
    if (corner_angle(positions[p], a, b) + corner_angle(positions[q], a, b) < 3.1416 + 1e-3) continue;
    int i = 0;
    while (triangles[t][i] == p || triangles[t][(i + 1) % 3] == p) ++i;  // the edge, in the direction of t
    const int32_t from = triangles[t][i], to = triangles[t][(i + 1) % 3];
    const Vector3 first = normal_of(positions[p], positions[from], positions[q]),
                  second = normal_of(positions[q], positions[to], positions[p]);
    if (!(first.dot(second) > 0)) continue;  // not convex: would fold
    triangles[t] = {p, from, q}, triangles[s] = {q, to, p};
    turned[t] = turned[s] = 1;
    added.insert(flipped);
  }
  return !added.empty();
}

using NeighbourSets = std::vector<std::set<int32_t>>;

// The umbrella of each vertex of a patch, mean of its neighbours minus itself: umbrella * inner positions +
// constant.
struct Umbrellas {
  Matrix umbrella, constant;
};

Umbrellas umbrellas_of(const HoleLoop& loop, const std::vector<Vector3>& positions,
                       const NeighbourSets& near) {
  const auto n = static_cast<int32_t>(loop.positions.size()), all = static_cast<int32_t>(positions.size());
  Umbrellas result{Matrix::Zero(all, all - n), Matrix::Zero(all, 3)};
  for (int32_t v = 0; v < all; ++v) {
    const auto add = [&](int32_t w, double factor) {
      if (w >= n)
        result.umbrella(v, w - n) += factor;
      else
        result.constant.row(v) += factor * positions[w].transpose();
    };
    std::vector<int32_t> patch_only;
    for (const int32_t w : near[v]) {  // the rim itself is already among the surface's neighbours
      const bool on_rim = v < n && w < n && (w == (v + 1) % n || v == (w + 1) % n);
      if (!on_rim) patch_only.push_back(w);
    }
    const double outer = v < n ? loop.outer_count[v] : 0;
    const double degree = static_cast<double>(patch_only.size()) + outer;
    for (const int32_t w : patch_only) add(w, 1 / degree);
    if (v < n) result.constant.row(v) += loop.outer_sum[v].transpose() / degree;
    add(v, -1);
  }
  return result;
}

// Smooth: positions where the umbrella of the umbrellas is zero, so that the patch continues the surface at
// the rim. Otherwise where the umbrella is zero: a soap film.
void Patch::fair(bool is_smooth) {
  const auto n = static_cast<int32_t>(loop.positions.size()), all = static_cast<int32_t>(positions.size());
  const int32_t inner = all - n;
  if (inner == 0) return;
  NeighbourSets near(all);
  for (const auto& t : triangles)
    for (int i = 0; i < 3; ++i) near[t[i]].insert(t[(i + 1) % 3]), near[t[(i + 1) % 3]].insert(t[i]);
  const auto [umbrella, constant] = umbrellas_of(loop, positions, near);
  Matrix system = -umbrella.bottomRows(inner), right = constant.bottomRows(inner);
  for (int32_t v = n; is_smooth && v < all; ++v)
    for (const int32_t w : near[v]) {
      system.row(v - n) += umbrella.row(w) / static_cast<double>(near[v].size());
      right.row(v - n) -= constant.row(w) / static_cast<double>(near[v].size());
    }
  const Matrix solution = system.partialPivLu().solve(right);
  const Vector3 middle = positions[0];
  double reach = 0;
  for (int32_t v = 0; v < n; ++v) reach = std::max(reach, (positions[v] - middle).norm());
  const bool sane = solution.allFinite() &&
                    (solution.rowwise() - middle.transpose()).rowwise().norm().maxCoeff() < 2 * reach;
  for (int32_t v = 0; sane && v < inner; ++v) positions[n + v] = solution.row(v);
}

// Whether the surface continues across the hole, or ends there like the stump of a limb. A smooth patch would
// extend a stump by a round tip; a flat end is more accurate (head cut off: 1.8 instead of 3.9 edges, open
// 6.2).
bool runs_across(const HoleLoop& loop) {
  const size_t n = loop.positions.size();
  Vector3 area = Vector3::Zero(), sum = Vector3::Zero();
  for (size_t i = 0; i < n; ++i) {
    area += (loop.positions[i] - loop.positions[0]).cross(loop.positions[(i + 1) % n] - loop.positions[0]);
    sum += loop.outer_normal[i];
  }
  return sum.dot(area) > stump_alignment * area.norm() * static_cast<double>(n);
}

}  // namespace

HolePatch patch_hole(const HoleLoop& loop) {
  Patch patch{loop, loop.positions, loop.density, {}};
  std::vector<int32_t> corners(loop.positions.size());
  for (size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<int32_t>(i);
  if (corners.size() < 3 || !triangulate(loop, std::move(corners), patch.triangles)) return {};
  for (int round = 0; round < max_rounds; ++round) {
    const bool any = patch.split_large();
    for (int sweep = 0; sweep < max_rounds && patch.flip_edges(); ++sweep) {
    }
    if (!any) break;
  }
  patch.fair(runs_across(loop));
  return {
      {patch.positions.begin() + static_cast<std::ptrdiff_t>(loop.positions.size()), patch.positions.end()},
      std::move(patch.triangles)};
}

}  // namespace focal
