#include "geodesics/distance.h"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>

#include "base/aligned_array.h"

namespace focal {
namespace {

constexpr int lanes = Distance::lanes;

Distance::BlockSink into_rows(RowMatrixf& rows) {
  return [&rows](int64_t first, int32_t count, const float* distances) {
    for (Eigen::Index v = 0; v < rows.cols(); ++v)
      for (int32_t j = 0; j < count; ++j) rows(first + j, v) = distances[v * lanes + j];
  };
}

}  // namespace

double diameter_bound(const TriangleMesh& mesh, const SparseMatrix& L) {
  std::vector<double> distance(mesh.vertex_count(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.emplace(distance[0] = 0, 0);
  double farthest = 0;
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[v]) continue;
    farthest = d;
    for (SparseMatrix::InnerIterator it(L, v); it; ++it) {
      const double next = d + (mesh.positions.row(v) - mesh.positions.row(it.row())).norm();
      if (next < distance[it.row()]) queue.emplace(distance[it.row()] = next, static_cast<int32_t>(it.row()));
    }
  }
  return 2 * farthest;
}

void Distance::run(std::span<const Source> sources, const Execution& execution, const BlockSink& sink) const {
  const auto count = static_cast<int64_t>(sources.size());
  parallel_for(execution, (count + lanes - 1) / lanes, [&](int64_t block) {
    const AlignedArray<float> out(static_cast<size_t>(vertex_count()) * lanes);
    const int64_t first = block * lanes;
    const auto used = static_cast<int32_t>(std::min<int64_t>(lanes, count - first));
    solve_block(sources.subspan(first, used), out.data(), execution);
    sink(first, used, out.data());
  });
}

void Distance::for_each_block(std::span<const SurfacePoint> points, const Execution& execution,
                              const BlockSink& sink) const {
  std::vector<Source> sources(points.size());
  for (size_t s = 0; s < points.size(); ++s) {
    const auto& weight = points[s].barycentric;
    const auto corner = [&](int i) { return positions_.row(triangles_(points[s].triangle, i)); };
    const Eigen::RowVector3d place = weight[0] * corner(0) + weight[1] * corner(1) + weight[2] * corner(2);
    for (int i = 0; i < 3; ++i) {
      sources[s].vertex[i] = triangles_(points[s].triangle, i);
      sources[s].weight[i] = weight[i];
      sources[s].corner_distance += static_cast<float>(weight[i] * (corner(i) - place).norm());
    }
    sources[s].triangle = points[s].triangle;
  }
  run(sources, execution, sink);
}

void Distance::for_each_block(std::span<const int32_t> vertices, const Execution& execution,
                              const BlockSink& sink) const {
  std::vector<Source> sources(vertices.size());
  for (size_t s = 0; s < vertices.size(); ++s)
    sources[s] = {{vertices[s], vertices[s], vertices[s]}, {1, 0, 0}};
  run(sources, execution, sink);
}

RowMatrixf Distance::distances(std::span<const SurfacePoint> sources, const Execution& execution) const {
  RowMatrixf result(sources.size(), vertex_count());
  for_each_block(sources, execution, into_rows(result));
  return result;
}

RowMatrixf Distance::distances(std::span<const int32_t> source_vertices, const Execution& execution) const {
  RowMatrixf result(source_vertices.size(), vertex_count());
  for_each_block(source_vertices, execution, into_rows(result));
  return result;
}

#define FOCAL_DECLARE(name) DistanceKind name##_distance();
#define FOCAL_MAKE(name) name##_distance(),
FOCAL_DISTANCES(FOCAL_DECLARE)

std::span<const DistanceKind> distance_kinds() {
  static const std::array all = {FOCAL_DISTANCES(FOCAL_MAKE)};
  return all;
}

std::vector<float> distances_on(const PreparedMesh& mesh, const DistanceKind& kind,
                                const SurfacePoint& source, const Execution& execution) {
  execution.begin_stage("distances", 0, 1);
  const auto bridges = bridges_of(mesh);
  const Operators operators = make_operators(mesh.surface, bridges);
  const auto distance = kind.make({mesh.surface, bridges, operators, true}, execution);
  const RowMatrixf row = distance->distances(std::span(&source, 1), execution);
  std::vector<float> result(mesh.surface_vertex.size(), std::numeric_limits<float>::infinity());
  const auto unit = static_cast<float>(kind.is_length ? mesh.scale : 1);
  for (size_t v = 0; v < result.size(); ++v)
    if (mesh.surface_vertex[v] >= 0) result[v] = unit * row(0, mesh.surface_vertex[v]);
  return result;
}

}  // namespace focal
