#include "operators/operators.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "operators/intrinsic_delaunay.h"

namespace focal {
namespace {

// Corners of triangle t as columns, and the edge opposite to each corner.
struct Corners {
  Eigen::Matrix3d at, opposite;
  Vector3 normal;  // of length twice the area
  Corners(const TriangleMesh& mesh, int32_t t) {
    for (int i = 0; i < 3; ++i) at.col(i) = mesh.positions.row(mesh.triangles(t, i));
    for (int i = 0; i < 3; ++i) opposite.col(i) = at.col((i + 2) % 3) - at.col((i + 1) % 3);
    normal = opposite.col(0).cross(opposite.col(1));
  }
  // Gradient of the hat function of corner i times twice the area: n x e_i with a unit normal n.
  Vector3 scaled_hat_gradient(int i) const { return normal.normalized().cross(opposite.col(i)); }
};

// From the positions of the corners, which is more accurate than from lengths where a triangle is thin.
TriangleMeasure measure_corners(const TriangleMesh& mesh, int32_t t, double smallest_area) {
  const Corners corners(mesh, t);
  const double twice = corners.normal.norm();
  TriangleMeasure result{twice / 2, {}};
  for (int i = 0; i < 3; ++i)
    result.half_cotangent[i] = -corners.opposite.col((i + 1) % 3).dot(corners.opposite.col((i + 2) % 3)) / 2 /
                               std::max(twice, 2 * smallest_area);
  return result;
}

// Ratio of mass, relative to the area, to the diagonal of L: far below the values of real shapes.
constexpr double min_mass_by_stiffness = 1e-10;

struct WeightedEdge {
  int32_t a, b;
  double weight;
};

// Column by column: weights of equal edges are added in their order; the diagonal makes the sum 0.
SparseMatrix laplacian_of(const std::vector<WeightedEdge>& edges, int32_t n) {
  std::vector<int32_t> start(n + 1, 0);
  for (const auto& edge : edges) ++start[edge.a + 1], ++start[edge.b + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::pair<int32_t, double>> beside(start[n]);
  std::vector<int32_t> next(start.begin(), start.end() - 1);
  for (const auto& edge : edges) {
    beside[next[edge.a]++] = {edge.b, edge.weight};
    beside[next[edge.b]++] = {edge.a, edge.weight};
  }
  SparseMatrix L(n, n);
  L.reserve(start[n] / 2 + n);
  for (int32_t v = 0; v < n; ++v) {
    const auto begin = beside.begin() + start[v], end = beside.begin() + start[v + 1];
    std::stable_sort(begin, end, [](const auto& a, const auto& b) { return a.first < b.first; });
    double sum = 0;
    for (auto it = begin; it != end; ++it) sum += it->first == v ? 0 : it->second;
    bool placed = false;  // the diagonal was inserted
    L.startVec(v);
    for (auto it = begin; it != end;) {
      const int32_t other = it->first;
      double weight = 0;
      for (; it != end && it->first == other; ++it) weight += it->second;
      if (other == v) continue;  // an edge from a vertex to itself cancels
      if (other > v && !std::exchange(placed, true)) L.insertBack(v, v) = sum;
      L.insertBack(other, v) = -weight;
    }
    if (!placed) L.insertBack(v, v) = sum;
  }
  L.finalize();
  return L;
}

}  // namespace

Operators make_operators(const TriangleMesh& mesh, std::span<const std::pair<int32_t, int32_t>> bridges,
                         bool delaunay) {
  Operators result;
  const IntrinsicTriangulation surface = delaunay ? intrinsic_delaunay(mesh) : intrinsic_copy(mesh);
  result.triangles = surface.triangles;
  const auto n = mesh.vertex_count(), m = static_cast<int32_t>(surface.triangles.rows());
  result.half_cotangent.resize(m, 3);
  result.face_area.resize(m);
  result.area = surface_area(mesh);
  result.mean_edge = mean_edge_length(mesh);
  result.mass = Vector::Zero(n);
  std::vector<WeightedEdge> edges;
  edges.reserve(3 * static_cast<size_t>(m) + bridges.size());
  for (int32_t t = 0; t < m; ++t) {
    // The lower limit keeps slivers finite; it is far below the area of any relevant triangle.
    TriangleMeasure triangle = delaunay ? measure(surface.lengths.row(t), 5e-13 * result.area)
                                        : measure_corners(mesh, t, 5e-13 * result.area);
    triangle.area /= surface.layers, triangle.half_cotangent /= surface.layers;
    result.face_area[t] = triangle.area;
    result.half_cotangent.row(t) = triangle.half_cotangent;
    for (int i = 0; i < 3; ++i) {
      edges.push_back(
          {surface.triangles(t, (i + 1) % 3), surface.triangles(t, (i + 2) % 3), triangle.half_cotangent[i]});
      result.mass[surface.triangles(t, i)] += triangle.area / 3;
    }
  }
  for (const auto& [a, b] : bridges) edges.push_back({a, b, 1});
  result.mass =
      result.mass.cwiseMax(1e-9 * result.area / n);  // a vertex with slivers only still has some mass
  result.L = laplacian_of(edges, n);
  // Also limits the ratio of mass to stiffness, so that the eigenvalues stay within the range of double
  // precision.
  result.mass = result.mass.cwiseMax(min_mass_by_stiffness * result.area * result.L.diagonal());
  return result;
}

std::vector<int32_t> connected_ball(const SparseMatrix& L, const MatrixX3& positions, int32_t centre,
                                    double radius) {
  std::vector<int32_t> inside = {centre};
  std::vector<char> seen(positions.rows(), 0);
  seen[centre] = 1;
  for (size_t i = 0; i < inside.size(); ++i)
    for (SparseMatrix::InnerIterator it(L, inside[i]); it; ++it) {
      const auto v = static_cast<int32_t>(it.row());
      if (seen[v] || (positions.row(v) - positions.row(centre)).norm() >= radius) continue;
      seen[v] = 1, inside.push_back(v);
    }
  return inside;
}

MatrixX3 gradient(const TriangleMesh& mesh, const Vector& u) {
  MatrixX3 result = MatrixX3::Zero(mesh.triangle_count(), 3);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const Corners corners(mesh, t);
    const double twice = corners.normal.norm();
    if (!(twice > 0)) continue;
    for (int i = 0; i < 3; ++i)
      result.row(t) += u[mesh.triangles(t, i)] * corners.scaled_hat_gradient(i).transpose() / twice;
  }
  return result;
}

Vector divergence(const TriangleMesh& mesh, const MatrixX3& X) {
  Vector result = Vector::Zero(mesh.vertex_count());
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const Corners corners(mesh, t);
    for (int i = 0; i < 3; ++i)
      result[mesh.triangles(t, i)] -= X.row(t).dot(corners.scaled_hat_gradient(i)) / 2;
  }
  return result;
}

MatrixX3 face_normals(const TriangleMesh& mesh) {
  MatrixX3 result(mesh.triangle_count(), 3);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    result.row(t) = Corners(mesh, t).normal.stableNormalized().transpose();
  return result;
}

}  // namespace focal
