#include "mesh/closest_point.h"

#include <algorithm>
#include <array>
#include <limits>

#include "mesh/triangle_tree.h"

namespace focal {
namespace {

struct Nearest {
  SurfacePoint point;
  double squared = std::numeric_limits<double>::infinity();
};

void consider(const TriangleMesh& mesh, int32_t t, const SurfaceQuery& query, Nearest& nearest) {
  Vector3 at[3];
  for (int i = 0; i < 3; ++i) at[i] = mesh.positions.row(mesh.triangles(t, i));
  if ((at[1] - at[0]).cross(at[2] - at[0]).dot(query.normal) < 0) return;
  const Vector3 weights = closest_on_triangle(query.position, at[0], at[1], at[2]);
  const Vector3 place = weights[0] * at[0] + weights[1] * at[1] + weights[2] * at[2];
  const double squared = (place - query.position).squaredNorm();
  if (squared < nearest.squared || (squared == nearest.squared && t < nearest.point.triangle))
    nearest = {{t, weights}, squared};
}

SurfaceQuery facing_anywhere(const SurfaceQuery& query) { return {query.position, Vector3::Zero()}; }

// Finds the queries whose ball may reach a triangle, by slabs along the longest axis of all queries.
class QuerySlabs {
 public:
  QuerySlabs(std::span<const SurfaceQuery> queries, const std::vector<int32_t>& open, double radius) {
    Eigen::AlignedBox3d box;
    for (const int32_t q : open) box.extend(queries[q].position);
    box.sizes().maxCoeff(&axis_);
    low_ = box.min()[axis_] - radius;
    to_slab_ = slabs / std::max(box.sizes()[axis_] + 2 * radius, std::numeric_limits<double>::min());
    for (const int32_t q : open) {
      const double at = queries[q].position[axis_];
      for (int s = slab_of(at - radius); s <= slab_of(at + radius); ++s) of_[s].push_back(q);
    }
  }
  // Calls visit(query) for the queries of every slab between two coordinates; it may visit a query twice.
  template <class Visit>
  void for_each(const Eigen::RowVector3d& low, const Eigen::RowVector3d& high, const Visit& visit) const {
    if ((high[axis_] - low_) * to_slab_ < 0 || (low[axis_] - low_) * to_slab_ > slabs) return;
    for (int s = slab_of(low[axis_]); s <= slab_of(high[axis_]); ++s)
      for (const int32_t q : of_[s]) visit(q);
  }

 private:
  static constexpr int slabs = 256;
  int slab_of(double at) const {
    return static_cast<int>(std::clamp((at - low_) * to_slab_, 0.0, static_cast<double>(slabs - 1)));
  }
  Eigen::Index axis_ = 0;
  double low_ = 0, to_slab_ = 0;
  std::array<std::vector<int32_t>, slabs> of_;
};

// Tests exactly only those of the triangles [begin, end) whose box is within the radius.
void search(const TriangleMesh& mesh, std::span<const SurfaceQuery> queries, const QuerySlabs& slabs,
            double radius, int64_t begin, int64_t end, std::vector<Nearest>& found) {
  for (auto t = static_cast<int32_t>(begin); t < end; ++t) {
    const auto a = mesh.positions.row(mesh.triangles(t, 0)), b = mesh.positions.row(mesh.triangles(t, 1)),
               c = mesh.positions.row(mesh.triangles(t, 2));
    const Eigen::RowVector3d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    slabs.for_each(low, high, [&](int32_t q) {
      const Eigen::RowVector3d p = queries[q].position;
      if ((p.array() + radius >= low.array()).all() && (p.array() - radius <= high.array()).all())
        consider(mesh, t, queries[q], found[q]);
    });
  }
}

// One pass over the triangles for all queries without a result.
void search_all(const TriangleMesh& mesh, std::span<const SurfaceQuery> queries, double radius,
                std::vector<Nearest>& found, const Execution& execution) {
  constexpr int64_t grain = 1 << 14;  // tens of milliseconds
  std::vector<int32_t> open;
  for (size_t q = 0; q < queries.size(); ++q)
    if (found[q].point.triangle < 0) open.push_back(static_cast<int32_t>(q));
  const QuerySlabs slabs(queries, open, radius);
  std::vector<std::vector<Nearest>> parts((mesh.triangle_count() + grain - 1) / grain);
  parallel_for_ranges(execution, mesh.triangle_count(), grain, [&](int64_t begin, int64_t end) {
    auto& part = parts[begin / grain];
    part.resize(queries.size());
    search(mesh, queries, slabs, radius, begin, end, part);
  });
  for (const auto& part : parts)
    for (const int32_t q : open)
      if (part[q].squared < found[q].squared) found[q] = part[q];
}

std::vector<SurfacePoint> closest_of_some(const TriangleMesh& mesh, std::span<const SurfaceQuery> queries,
                                          double radius, const Execution& execution) {
  std::vector<Nearest> found(queries.size());
  const auto missing = [](const Nearest& n) { return n.point.triangle < 0; };
  const double everywhere = 1e6 * radius + 1e6;
  for (int round = 0; round < 4 && std::any_of(found.begin(), found.end(), missing); ++round, radius *= 4)
    search_all(mesh, queries, round == 3 ? everywhere : radius, found, execution);
  std::vector<SurfacePoint> result;
  for (size_t q = 0; q < queries.size(); ++q) {
    if (missing(found[q]))  // no triangle has a matching normal: accept any
      for (int32_t t = 0; t < mesh.triangle_count(); ++t)
        consider(mesh, t, facing_anywhere(queries[q]), found[q]);
    result.push_back(found[q].point);
  }
  return result;
}

SurfacePoint closest_in(const TriangleTree& tree, const TriangleMesh& mesh, const SurfaceQuery& query) {
  // The distance of a box may round to more than that of a triangle touching it.
  constexpr double rounding = 1 + 1e-12;
  Nearest nearest;
  tree.search([&](const Eigen::AlignedBox3d& box) { return box.squaredExteriorDistance(query.position); },
              [&] { return nearest.squared * rounding; },
              [&](int32_t t) { consider(mesh, t, query, nearest); });
  return nearest.point;
}

// Number of queries for which building a tree pays off: hundreds.
std::vector<SurfacePoint> closest_of_many(const TriangleMesh& mesh, std::span<const SurfaceQuery> queries,
                                          const Execution& execution) {
  const TriangleTree tree(mesh, execution);
  std::vector<SurfacePoint> result(queries.size());
  parallel_for_ranges(execution, static_cast<int64_t>(queries.size()), 32, [&](int64_t begin, int64_t end) {
    for (int64_t q = begin; q < end; ++q) {
      result[q] = closest_in(tree, mesh, queries[q]);
      if (result[q].triangle < 0) result[q] = closest_in(tree, mesh, facing_anywhere(queries[q]));
    }
  });
  return result;
}

}  // namespace

std::vector<SurfacePoint> closest_points(const TriangleMesh& mesh, std::span<const SurfaceQuery> queries,
                                         double radius, const Execution& execution) {
  constexpr size_t few = 512;
  return queries.size() <= few ? closest_of_some(mesh, queries, radius, execution)
                               : closest_of_many(mesh, queries, execution);
}

Vector3 closest_on_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
               d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return Vector3(1, 0, 0);
  if (d3 >= 0 && d4 <= d3) return Vector3(0, 1, 0);
  if (d6 >= 0 && d5 <= d6) return Vector3(0, 0, 1);
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return Vector3(1 - d1 / (d1 - d3), d1 / (d1 - d3), 0);
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return Vector3(1 - d2 / (d2 - d6), 0, d2 / (d2 - d6));
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return Vector3(0, 1 - w, w);
  }
  const double sum = va + vb + vc;
  // A degenerate triangle: its first corner.
  return sum > 0 ? Vector3(va / sum, vb / sum, vc / sum) : Vector3(1, 0, 0);
}

}  // namespace focal
