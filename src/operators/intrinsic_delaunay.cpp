#include "operators/intrinsic_delaunay.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "operators/tufted_cover.h"

namespace focal {
namespace {

// Minimum amount by which two sides of a triangle must exceed the third, in mean edge lengths: before
// flipping, as in the paper; and after a flip, because below it lengths are mostly rounding errors.
constexpr double slack_before = 1e-5, slack_after = 1e-12;
constexpr double tolerance = 1e-10;  // of the sum of cotangents: smaller gains of a flip are rounding errors

class Flipper {
 public:
  // twin: the side that each is glued to, or -1.
  Flipper(IntrinsicTriangulation& surface, std::vector<int32_t> twin)
      : surface_(surface), twin_(std::move(twin)), min_slack_(slack_after * surface.lengths.mean()) {}

  void run() {
    const auto count = static_cast<int32_t>(twin_.size());
    queued_.assign(count, 1);
    for (int32_t s = count - 1; s >= 0; --s) queue_.push_back(s);
    // Every flip lowers the Dirichlet energy, so this terminates; the bound guards against rounding errors.
    for (int64_t left = 20 * int64_t{count} + 1000; left > 0 && !queue_.empty(); --left) {
      const int32_t side = queue_.back();
      queue_.pop_back();
      queued_[side] = 0;
      if (twin_[side] >= 0 && twin_[side] / 3 != side / 3 && !is_delaunay(side)) flip(side);
    }
  }

 private:
  double length(int32_t side) const { return surface_.lengths(side / 3, side % 3); }
  static int32_t next(int32_t side) { return side % 3 == 2 ? side - 2 : side + 1; }
  static int32_t previous(int32_t side) { return side % 3 == 0 ? side + 2 : side - 1; }

  double cotangent(int32_t side) const {  // at the corner opposite to the side
    const double a = length(side), b = length(next(side)), c = length(previous(side));
    const double area = std::sqrt(std::max((a + b + c) * (b + c - a) * (a + c - b) * (a + b - c), 0.0)) / 4;
    return (b * b + c * c - a * a) / (4 * std::max(area, 1e-30));
  }
  static double slack(double a, double b, double c) { return a + b + c - 2 * std::max({a, b, c}); }
  bool is_delaunay(int32_t side) const { return cotangent(side) + cotangent(twin_[side]) > -tolerance; }

  // The triangles (p, a, b) and (q, b, a) on either side of the edge ab become (p, a, q) and (q, b, p).
  void flip(int32_t side) {
    const int32_t other = twin_[side], t = side / 3, u = other / 3;
    const int32_t bp = next(side), pa = previous(side), aq = next(other), qb = previous(other);
    const double along = length(side);
    const auto place = [&](double from_a, double from_b) {  // of a corner, with a at 0 and b at `along`
      const double x = (from_a * from_a - from_b * from_b + along * along) / (2 * along);
      return std::pair{x, std::sqrt(std::max(from_a * from_a - x * x, 0.0))};
    };
    const auto [px, py] = place(length(pa), length(bp));
    const auto [qx, qy] = place(length(aq), length(qb));
    const double crossing = std::hypot(px - qx, py + qy);
    const double l_bp = length(bp), l_pa = length(pa), l_aq = length(aq), l_qb = length(qb);
    if (!(slack(l_pa, l_aq, crossing) > min_slack_ && slack(l_bp, l_qb, crossing) > min_slack_)) return;
    const auto& corner = surface_.triangles;
    const int32_t p = corner(t, side % 3), q = corner(u, other % 3);
    const int32_t a = corner(t, bp % 3), b = corner(t, pa % 3);
    const int32_t outside[4] = {twin_[aq], twin_[pa], twin_[bp], twin_[qb]};
    const int32_t moved_from[4] = {aq, pa, bp, qb};
    // New sides: of t = (p, a, q): opposite to p: aq; to a: qp; to q: pa. Of u = (q, b, p): bp, pq, qb.
    const int32_t moved_to[4] = {3 * t, 3 * t + 2, 3 * u, 3 * u + 2};
    surface_.triangles.row(t) << p, a, q;
    surface_.lengths.row(t) << l_aq, crossing, l_pa;
    surface_.triangles.row(u) << q, b, p;
    surface_.lengths.row(u) << l_bp, crossing, l_qb;
    for (int k = 0; k < 4; ++k) {
      int32_t beyond = outside[k];
      for (int m = 0; m < 4; ++m)  // an edge between these two triangles
        if (beyond == moved_from[m]) beyond = moved_to[m];
      twin_[moved_to[k]] = beyond;
    }
    for (int k = 0; k < 4; ++k)
      if (twin_[moved_to[k]] >= 0) twin_[twin_[moved_to[k]]] = moved_to[k];
    twin_[3 * t + 1] = 3 * u + 1, twin_[3 * u + 1] = 3 * t + 1;
    for (const int32_t s : moved_to) enqueue(s);
    ++surface_.flips;
  }

  void enqueue(int32_t side) {
    if (queued_[side]) return;
    queued_[side] = 1, queue_.push_back(side);
  }

  IntrinsicTriangulation& surface_;
  std::vector<int32_t> twin_, queue_;
  double min_slack_;
  std::vector<char> queued_;
};

}  // namespace

IntrinsicTriangulation intrinsic_copy(const TriangleMesh& mesh) {
  IntrinsicTriangulation result{mesh.triangles, MatrixX3(mesh.triangle_count(), 3)};
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i)
      result.lengths(t, i) = (mesh.positions.row(mesh.triangles(t, (i + 1) % 3)) -
                              mesh.positions.row(mesh.triangles(t, (i + 2) % 3)))
                                 .norm();
  return result;
}

void mollify(MatrixX3& lengths, double share) {
  const double slack = share * lengths.mean();
  double missing = 0;
  for (Eigen::Index t = 0; t < lengths.rows(); ++t)
    missing = std::max(missing, slack + 2 * lengths.row(t).maxCoeff() - lengths.row(t).sum());
  lengths.array() += missing;
}

IntrinsicTriangulation intrinsic_delaunay(const TriangleMesh& mesh) {
  IntrinsicTriangulation result = intrinsic_copy(mesh);
  mollify(result.lengths, slack_before);
  const EdgeSides edges = edge_sides(mesh);
  auto twin = manifold_gluing(mesh.triangles, edges);
  if (!twin) {
    TuftedCover cover = tufted_cover(mesh.triangles, edges);
    const MatrixX3 above = result.lengths;
    result.triangles = std::move(cover.triangles);
    result.lengths.resize(2 * above.rows(), 3);
    result.lengths << above, above.col(0), above.col(2), above.col(1);
    result.layers = 2;
    twin = std::move(cover.twin);
  }
  Flipper(result, std::move(*twin)).run();
  return result;
}

TriangleMeasure measure(const Vector3& l, double smallest_area) {
  const double product =
      (l[0] + l[1] + l[2]) * (l[1] + l[2] - l[0]) * (l[0] + l[2] - l[1]) * (l[0] + l[1] - l[2]);
  const double area = std::sqrt(std::max(product, 0.0)) / 4;
  const Vector3 squared = l.cwiseProduct(l);
  return {area, (Vector3::Constant(squared.sum()) - 2 * squared) / (8 * std::max(area, smallest_area))};
}

}  // namespace focal
