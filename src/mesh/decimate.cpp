#include "mesh/decimate.h"

#include <meshoptimizer.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <vector>

#include "mesh/collapse.h"

namespace focal {
namespace {

using Positions = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Indices = std::vector<unsigned>;  // three per triangle

// A large surface is first cut into slabs. Each is decimated on its own, except at its borders, to a few
// times the wanted number of vertices: in parallel, within the cache, and with checks for cancellation in
// between.
constexpr int32_t slab_vertices = 25'000;
constexpr int32_t slabs_from = 40'000;       // vertices
constexpr double left_by_slabs = 8;          // times the wanted number of vertices
constexpr int64_t chunk = int64_t{1} << 16;  // of vertices or triangles, for sums in a fixed order

// Rotates the mesh to its principal axes, the longest first: the decimation scales by the bounding box, so a
// rotated mesh would otherwise lose other vertices. The first axis points to the farthest part of the
// surface.
Positions upright_positions(const MatrixX3& positions, const Execution& execution) {
  const int64_t n = positions.rows(), chunks = (n + chunk - 1) / chunk;
  const auto rows = [&](int64_t c) {
    return positions.middleRows(c * chunk, std::min(chunk, n - c * chunk));
  };
  std::vector<Eigen::RowVector3d> sums(chunks);
  parallel_for(execution, chunks, [&](int64_t c) { sums[c] = rows(c).colwise().sum(); });
  const Eigen::RowVector3d centre =
      std::accumulate(sums.begin(), sums.end(), Eigen::RowVector3d(0, 0, 0)) / static_cast<double>(n);
  std::vector<Eigen::Matrix3d> spreads(chunks);
  parallel_for(execution, chunks, [&](int64_t c) {
    const MatrixX3 centred = rows(c).rowwise() - centre;
    spreads[c] = centred.transpose() * centred;
  });
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& part : spreads) spread += part;
  const Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().rowwise().reverse();
  Positions upright(n, 3);
  parallel_for(execution, chunks, [&](int64_t c) {
    upright.middleRows(c * chunk, rows(c).rows()) = ((rows(c).rowwise() - centre) * axes).cast<float>();
  });
  if (-upright.col(0).minCoeff() > upright.col(0).maxCoeff()) upright.col(0) *= -1;
  return upright;
}

Indices simplify(const Indices& indices, const Positions& positions, size_t triangles, unsigned options) {
  return collapse_edges(indices, positions, std::max<size_t>(triangles, 8), options);
}

// Simplifies the vertices that the triangles use, renumbered by first use. scratch: -1 for each vertex of the
// mesh; restored on return.
Indices simplify_alone(const Indices& indices, const Positions& positions, size_t triangles, unsigned options,
                       std::vector<int32_t>& scratch) {
  std::vector<unsigned> used;
  Indices local(indices.size());
  for (size_t i = 0; i < indices.size(); ++i) {
    int32_t& number = scratch[indices[i]];
    if (number < 0) number = static_cast<int32_t>(used.size()), used.push_back(indices[i]);
    local[i] = static_cast<unsigned>(number);
  }
  Positions places(used.size(), 3);
  for (size_t v = 0; v < used.size(); ++v) places.row(v) = positions.row(used[v]), scratch[used[v]] = -1;
  Indices kept = simplify(local, places, triangles, options);
  for (unsigned& v : kept) v = used[v];
  return kept;
}

// The slab of each triangle: equal numbers of triangles, in order along the first axis.
std::vector<uint16_t> slab_of_triangles(const MatrixX3i& triangles, const Positions& positions, int32_t slabs,
                                        const Execution& execution) {
  constexpr int32_t steps = 1 << 14;
  const float low = positions.col(0).minCoeff(), high = positions.col(0).maxCoeff();
  const float to_step = (steps - 1) / std::max(high - low, std::numeric_limits<float>::min());
  const int64_t m = triangles.rows(), chunks = (m + chunk - 1) / chunk;
  std::vector<uint16_t> of(m);
  std::vector<std::vector<int32_t>> counts(chunks);
  parallel_for_ranges(execution, m, chunk, [&](int64_t begin, int64_t end) {
    auto& count = counts[begin / chunk];
    count.assign(steps, 0);
    for (int64_t t = begin; t < end; ++t) {
      const float at =
          (positions(triangles(t, 0), 0) + positions(triangles(t, 1), 0) + positions(triangles(t, 2), 0)) / 3;
      ++count[of[t] = static_cast<uint16_t>((at - low) * to_step)];
    }
  });
  std::vector<uint16_t> slab(steps);
  int64_t before = 0;
  for (int32_t step = 0; step < steps; ++step) {
    slab[step] = static_cast<uint16_t>(std::min<int64_t>(before * slabs / m, slabs - 1));
    for (const auto& count : counts) before += count[step];
  }
  parallel_for_ranges(execution, m, chunk, [&](int64_t begin, int64_t end) {
    for (int64_t t = begin; t < end; ++t) of[t] = slab[of[t]];
  });
  return of;
}

Indices simplify_by_slabs(const TriangleMesh& mesh, const Positions& positions, int32_t vertices,
                          const Execution& execution) {
  const int32_t slabs = std::min(mesh.vertex_count() / slab_vertices, 1000);
  const auto of = slab_of_triangles(mesh.triangles, positions, slabs, execution);
  std::vector<Indices> parts(slabs);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) parts[of[t]].push_back(static_cast<unsigned>(mesh.triangles(t, i)));
  const double share = std::min(left_by_slabs * vertices / mesh.vertex_count(), 1.0);
  parallel_for(execution, slabs, [&](int64_t s) {
    std::vector<int32_t> scratch(mesh.vertex_count(), -1);
    const auto triangles = static_cast<size_t>(share * static_cast<double>(parts[s].size()) / 3);
    parts[s] = simplify_alone(parts[s], positions, triangles, meshopt_SimplifyLockBorder, scratch);
  });
  Indices all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// Collapses occasionally leave flaps: two triangles back to back on an edge of the surface, which then has
// four. Removing them keeps the surface manifold. (Sheets made of such pairs, like hair in games, are not
// changed.)
Indices without_flaps(const Indices& indices) {
  constexpr size_t max_share = 50;  // of all triangles, as a divisor: more are sheets
  std::map<std::array<unsigned, 3>, size_t> seen;
  std::vector<bool> dropped(indices.size() / 3, false);
  size_t flaps = 0;
  for (size_t t = 0; t < dropped.size(); ++t) {
    std::array<unsigned, 3> corners = {indices[3 * t], indices[3 * t + 1], indices[3 * t + 2]};
    std::sort(corners.begin(), corners.end());
    const auto [other, is_new] = seen.emplace(corners, t);
    if (is_new) continue;
    dropped[t] = dropped[other->second] = true;
    ++flaps;
  }
  if (flaps * max_share > dropped.size()) return indices;
  Indices kept;
  for (size_t t = 0; t < dropped.size(); ++t)
    if (!dropped[t]) kept.insert(kept.end(), indices.begin() + 3 * t, indices.begin() + 3 * t + 3);
  return kept;
}

Indices all_indices(const TriangleMesh& mesh) {
  return Indices(mesh.triangles.data(), mesh.triangles.data() + mesh.triangles.size());
}

}  // namespace

TriangleMesh decimate(const TriangleMesh& mesh, int32_t vertices, const Execution& execution) {
  const auto positions = upright_positions(mesh.positions, execution);
  const auto target =
      static_cast<size_t>(static_cast<double>(mesh.triangle_count()) * vertices / mesh.vertex_count());
  execution.check_cancelled();
  const Indices some = mesh.vertex_count() < slabs_from
                           ? all_indices(mesh)
                           : simplify_by_slabs(mesh, positions, vertices, execution);
  std::vector<int32_t> number(mesh.vertex_count(), -1), vertex;
  const Indices kept = without_flaps(simplify_alone(some, positions, target, 0, number));
  execution.check_cancelled();
  TriangleMesh result;
  result.triangles.resize(static_cast<Eigen::Index>(kept.size() / 3), 3);
  for (size_t i = 0; i < kept.size(); ++i) {
    int32_t& v = number[kept[i]];
    if (v < 0) v = static_cast<int32_t>(vertex.size()), vertex.push_back(static_cast<int32_t>(kept[i]));
    result.triangles.data()[i] = v;
  }
  result.positions = mesh.positions(vertex, Eigen::all);
  return result;
}

}  // namespace focal
