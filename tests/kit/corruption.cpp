// Other resolutions of the same surface: the corruptions that change every triangle.
#include "kit/corruption.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "mesh/closest_point.h"
#include "mesh/collapse.h"

namespace focal {
namespace {

using Edge = std::pair<int32_t, int32_t>;

CorruptedMesh decimated(CorruptedMesh corrupted, double factor) {
  const TriangleMesh& mesh = corrupted.mesh;
  const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> positions = mesh.positions.cast<float>();
  const std::vector<unsigned> indices(mesh.triangles.data(), mesh.triangles.data() + mesh.triangles.size());
  const auto wanted =
      std::min(indices.size() / 3, static_cast<size_t>(std::max(4.0, factor * mesh.triangle_count())));
  const std::vector<unsigned> kept = collapse_edges(indices, positions, wanted, 0);
  std::vector<SurfaceQuery> queries;
  for (const auto& mark : corrupted.marks) {
    if (!mark) continue;
    const auto corner = [&](int i) -> Vector3 {
      return mesh.positions.row(mesh.triangles(mark->triangle, i));
    };
    queries.push_back({position_of(mesh, *mark), (corner(1) - corner(0)).cross(corner(2) - corner(0))});
  }
  corrupted.mesh.triangles.resize(static_cast<Eigen::Index>(kept.size() / 3), 3);
  std::copy(kept.begin(), kept.end(), corrupted.mesh.triangles.data());
  corrupted.old_triangle.assign(kept.size() / 3, -1);
  const auto places = closest_points(corrupted.mesh, queries, 2 * mean_edge_length(corrupted.mesh));
  size_t next = 0;
  for (auto& mark : corrupted.marks)
    if (mark) mark = places[next++];
  const std::vector<char> all(kept.size() / 3, 1);
  return keep_triangles(std::move(corrupted), all);  // drops the vertices that went
}

struct Split {
  int32_t edge_corner = -1;  // the edge from this corner to the next; -1: whole
  int32_t middle = -1, other = -1;
  double along = 0;  // from the first corner to the second
};

// The longest edges, a few at random before longer ones, no two in one triangle, at most `count`.
std::vector<Split> choose_splits(const TriangleMesh& mesh, int32_t count, Random& random,
                                 std::vector<std::array<double, 3>>& ends) {
  struct Side {
    int32_t triangle, corner;
  };
  std::map<Edge, std::vector<Side>> sides;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int32_t i = 0; i < 3; ++i)
      sides[std::minmax({mesh.triangles(t, i), mesh.triangles(t, (i + 1) % 3)})].push_back({t, i});
  std::vector<std::tuple<double, Edge, double>> order;
  for (const auto& [edge, around] : sides) {
    const double length = (mesh.positions.row(edge.first) - mesh.positions.row(edge.second)).norm();
    const double rank = length * (0.75 + 0.5 * random.uniform());
    order.emplace_back(-rank, edge, 0.35 + 0.3 * random.uniform());
  }
  std::sort(order.begin(), order.end());
  std::vector<Split> splits(mesh.triangle_count());
  int32_t next = mesh.vertex_count();
  for (const auto& [rank, edge, along] : order) {
    const auto& around = sides[edge];
    const auto is_split = [&](const Side& side) { return splits[side.triangle].middle >= 0; };
    if (next - mesh.vertex_count() >= count) break;
    if (std::any_of(around.begin(), around.end(), is_split)) continue;
    for (const auto& [t, i] : around)
      splits[t] = {i, next, -1, mesh.triangles(t, i) == edge.first ? along : 1 - along};
    const Eigen::RowVector3d at =
        (1 - along) * mesh.positions.row(edge.first) + along * mesh.positions.row(edge.second);
    ends.push_back({at[0], at[1], at[2]});
    ++next;
  }
  return splits;
}

// Where a point of a split triangle lies: in (a, middle, c), the old one, or (middle, b, c), the new one.
SurfacePoint in_split(const SurfacePoint& point, const Split& split) {
  const int i = split.edge_corner, j = (i + 1) % 3;
  const double t = split.along, a = point.barycentric[i], b = point.barycentric[j];
  SurfacePoint result = point;
  if (b * (1 - t) <= a * t) {
    result.barycentric[j] = b / t;
    result.barycentric[i] = std::max(0.0, a - b * (1 - t) / t);
  } else {
    result.triangle = split.other;
    result.barycentric[i] = a / (1 - t);
    result.barycentric[j] = std::max(0.0, b - a * t / (1 - t));
  }
  return result;
}

CorruptedMesh split_edges(CorruptedMesh corrupted, int32_t count, Random& random) {
  std::vector<std::array<double, 3>> added;
  std::vector<Split> splits = choose_splits(corrupted.mesh, count, random, added);
  TriangleMesh& mesh = corrupted.mesh;
  const int32_t vertices = mesh.vertex_count(), triangles = mesh.triangle_count();
  mesh.positions.conservativeResize(vertices + static_cast<int32_t>(added.size()), 3);
  for (size_t v = 0; v < added.size(); ++v)
    mesh.positions.row(vertices + static_cast<int32_t>(v)) << added[v][0], added[v][1], added[v][2];
  corrupted.old_vertex.resize(mesh.vertex_count(), -1);
  int32_t next = triangles;
  for (auto& split : splits)
    if (split.middle >= 0) split.other = next++;
  mesh.triangles.conservativeResize(next, 3);
  corrupted.old_triangle.resize(next);
  for (int32_t t = 0; t < triangles; ++t) {
    const Split& split = splits[t];
    if (split.middle < 0) continue;
    mesh.triangles.row(split.other) = mesh.triangles.row(t);
    mesh.triangles(split.other, split.edge_corner) = split.middle;
    mesh.triangles(t, (split.edge_corner + 1) % 3) = split.middle;
    corrupted.old_triangle[split.other] = corrupted.old_triangle[t];
  }
  for (auto& mark : corrupted.marks)
    if (mark && splits[mark->triangle].middle >= 0) mark = in_split(*mark, splits[mark->triangle]);
  return corrupted;
}

}  // namespace

CorruptedMesh resampled(CorruptedMesh corrupted, double factor, Random& random) {
  if (corrupted.mesh.triangle_count() == 0) return corrupted;
  if (factor < 1) return decimated(std::move(corrupted), factor);
  const auto wanted = static_cast<int32_t>(std::lround(factor * corrupted.mesh.vertex_count()));
  for (int32_t before = -1;
       corrupted.mesh.vertex_count() < wanted && before != corrupted.mesh.vertex_count();) {
    before = corrupted.mesh.vertex_count();
    corrupted = split_edges(std::move(corrupted), wanted - before, random);
  }
  return corrupted;
}

CorruptedMesh cut_beyond(CorruptedMesh corrupted, const Vector3& point, const Vector3& normal, CutEnd end) {
  std::vector<char> lost(corrupted.mesh.vertex_count());
  for (int32_t v = 0; v < corrupted.mesh.vertex_count(); ++v)
    lost[v] = (corrupted.mesh.positions.row(v).transpose() - point).dot(normal) > 0;
  return without_vertices(std::move(corrupted), lost, end);
}

CorruptedMesh moved(CorruptedMesh corrupted, const Matrix4& map) {
  corrupted.mesh.positions = corrupted.mesh.positions * map.topLeftCorner<3, 3>().transpose();
  corrupted.mesh.positions.rowwise() += map.topRightCorner<3, 1>().transpose();
  return corrupted;
}

Matrix4 random_similarity(double scale, double distance, Random& random) {
  const double w = random.normal(), x = random.normal(), y = random.normal(), z = random.normal();
  Matrix4 map = Matrix4::Identity();
  map.topLeftCorner<3, 3>() = scale * Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  for (int i = 0; i < 3; ++i) map(i, 3) = distance * (2 * random.uniform() - 1);
  return map;
}

}  // namespace focal
