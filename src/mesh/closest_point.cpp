#include "mesh/closest_point.h"

#include <algorithm>
#include <limits>

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
  if (squared < nearest.squared) nearest = {{t, weights}, squared};
}

// One pass over the triangles for all queries: those whose box comes within the radius are looked at closely.
void search(const TriangleMesh& mesh, std::span<const SurfaceQuery> queries, double radius,
            std::vector<Nearest>& found) {
  std::vector<size_t> open;
  for (size_t q = 0; q < queries.size(); ++q)
    if (found[q].point.triangle < 0) open.push_back(q);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto a = mesh.positions.row(mesh.triangles(t, 0)), b = mesh.positions.row(mesh.triangles(t, 1)),
               c = mesh.positions.row(mesh.triangles(t, 2));
    const Eigen::RowVector3d low = a.cwiseMin(b).cwiseMin(c).array() - radius,
                             high = a.cwiseMax(b).cwiseMax(c).array() + radius;
    for (const size_t q : open) {
      const Vector3& p = queries[q].position;
      if (p[0] < low[0] || p[0] > high[0] || p[1] < low[1] || p[1] > high[1] || p[2] < low[2] ||
          p[2] > high[2])
        continue;
      consider(mesh, t, queries[q], found[q]);
    }
  }
}

}  // namespace

std::vector<SurfacePoint> closest_points(const TriangleMesh& mesh, std::span<const SurfaceQuery> queries,
                                         double radius) {
  std::vector<Nearest> found(queries.size());
  const auto missing = [](const Nearest& n) { return n.point.triangle < 0; };
  for (int round = 0; round < 4 && std::any_of(found.begin(), found.end(), missing); ++round, radius *= 4)
    search(mesh, queries, round == 3 ? std::numeric_limits<double>::infinity() : radius, found);
  std::vector<SurfacePoint> result;
  for (size_t q = 0; q < queries.size(); ++q) {
    if (missing(found[q]))  // nothing faces that way: any triangle will do
      for (int32_t t = 0; t < mesh.triangle_count(); ++t)
        consider(mesh, t, {queries[q].position, Vector3::Zero()}, found[q]);
    result.push_back(found[q].point);
  }
  return result;
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
  return sum > 0 ? Vector3(va / sum, vb / sum, vc / sum)
                 : Vector3(1, 0, 0);  // a needle without area: its first corner
}

}  // namespace focal
