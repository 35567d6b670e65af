#include "geodesics/heat_method.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

#include "base/aligned_array.h"
#include "base/error.h"
#include "base/multiversion.h"

namespace focal {
namespace {

constexpr int lanes = HeatMethod::lanes;

// Heat falls off like exp(-d / sqrt(t)); a double holds about exp(-700).
constexpr double representable_decay = 650;

// An upper bound of the largest distance: twice the farthest edge path from one vertex (Dijkstra over L's graph).
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

SparseMatrix plus_diagonal(SparseMatrix A, const Vector& diagonal) {
  for (int32_t i = 0; i < A.rows(); ++i) A.coeffRef(i, i) += diagonal[i];
  return A;
}

// Right-hand side of the Poisson equation, all triangles and lanes. With u the heat, L_f the triangle's Laplacian and g
// the gradient, X = -g / |g| has integrated divergence L_f u / |g| at the corners, so no 3D vector is formed; and
// |g|^2 = u^T L_f u / area. u is first divided by its largest corner, which keeps tiny heat far away exact.
struct Faces {
  const int32_t* corner;     // count x 3
  const float* coefficient;  // count x 4: half cotangents, area
  int64_t count;
};

template <bool keep_negative>
FOCAL_INLINE void faces_body(const Faces& faces, const double* heat, float* rhs) {
  float d[3][lanes], weight[lanes], counts[lanes];
  for (int64_t f = 0; f < faces.count; ++f) {
    const int32_t* corner = faces.corner + 3 * f;
    const double *u0 = heat + int64_t{corner[0]} * lanes, *u1 = heat + int64_t{corner[1]} * lanes,
                 *u2 = heat + int64_t{corner[2]} * lanes;
    for (int j = 0; j < lanes; ++j) {
      const double largest = std::max(std::max(std::abs(u0[j]), std::abs(u1[j])), std::abs(u2[j]));
      const double scale = 1 / std::max(largest, 1e-290);
      d[0][j] = static_cast<float>((u1[j] - u2[j]) * scale);
      d[1][j] = static_cast<float>((u2[j] - u0[j]) * scale);
      d[2][j] = static_cast<float>((u0[j] - u1[j]) * scale);
      const double highest = keep_negative ? largest : std::max(std::max(u0[j], u1[j]), u2[j]);
      counts[j] = highest > 1e-290 ? 1.0f : 0.0f;
    }
    const float *c = faces.coefficient + 4 * f, c0 = c[0], c1 = c[1], c2 = c[2], area = c[3];
    for (int j = 0; j < lanes; ++j) {
      const float energy =
          c0 * d[0][j] * d[0][j] + c1 * d[1][j] * d[1][j] + c2 * d[2][j] * d[2][j];  // u^T L_f u
      weight[j] = counts[j] * std::sqrt(area / std::max(energy, 1e-30f));
    }
    float *b0 = rhs + int64_t{corner[0]} * lanes, *b1 = rhs + int64_t{corner[1]} * lanes,
          *b2 = rhs + int64_t{corner[2]} * lanes;
    for (int j = 0; j < lanes; ++j) {
      const float f0 = weight[j] * c0 * d[0][j], f1 = weight[j] * c1 * d[1][j], f2 = weight[j] * c2 * d[2][j];
      d[0][j] = f1 - f2, d[1][j] = f2 - f0, d[2][j] = f0 - f1;
    }
    for (int j = 0; j < lanes; ++j) b0[j] += d[0][j];
    for (int j = 0; j < lanes; ++j) b1[j] += d[1][j];
    for (int j = 0; j < lanes; ++j) b2[j] += d[2][j];
  }
}
FOCAL_MULTIVERSION(void add_faces(const Faces& faces, const double* heat, float* rhs),
                   faces_body<false>(faces, heat, rhs);)
FOCAL_MULTIVERSION(void add_faces_signed(const Faces& faces, const double* heat, float* rhs),
                   faces_body<true>(faces, heat, rhs);)

}  // namespace

HeatMethod::HeatMethod(const TriangleMesh& mesh, const Operators& operators, const Execution& execution,
                       double time_factor, bool keep_negative_heat)
    : keep_negative_heat_(keep_negative_heat) {
  execution.check_cancelled();
  const auto symbolic = std::make_shared<const SymbolicFactor>(analyse_pattern(operators.L));
  parallel_for(execution, 2, [&](int64_t part) {
    if (part == 0) {
      choose_time(mesh, operators, time_factor);
      heat_ = SparseCholesky(plus_diagonal(time_ * operators.L, operators.mass), symbolic);
    } else {  // The shift makes L definite. The constant mode is amplified by its inverse: 1e-6 leaves the float solve
      // five digits.
      poisson_ = SparseCholesky(plus_diagonal(operators.L, 1e-6 / operators.area * operators.mass), symbolic);
    }
  });
  execution.check_cancelled();
  sort_faces(mesh, operators);
}

void HeatMethod::choose_time(const TriangleMesh& mesh, const Operators& operators, double time_factor) {
  const double step = std::sqrt(time_factor) * operators.mean_edge;
  distance_bound_ = diameter_bound(mesh, operators.L);
  const double smallest = distance_bound_ / representable_decay;
  time_was_raised_ = smallest > step;
  time_ = std::pow(std::max(step, smallest), 2);
}

void HeatMethod::sort_faces(const TriangleMesh& mesh, const Operators& operators) {
  const auto& permutation = heat_.permutation();
  const MatrixX3i& triangles = operators.triangles;
  const auto m = static_cast<int32_t>(triangles.rows());
  positions_ = mesh.positions, triangles_ = mesh.triangles;
  faces_.resize(m, 3);
  face_coefficient_.resize(m, 4);
  std::vector<std::pair<int32_t, int32_t>> order(m);  // by smallest permuted corner
  for (int32_t t = 0; t < m; ++t)
    order[t] = {
        std::min({permutation[triangles(t, 0)], permutation[triangles(t, 1)], permutation[triangles(t, 2)]}),
        t};
  std::sort(order.begin(), order.end());
  for (int32_t f = 0; f < m; ++f) {
    const int32_t t = order[f].second;
    for (int i = 0; i < 3; ++i) {
      faces_(f, i) = permutation[triangles(t, i)];
      face_coefficient_(f, i) = static_cast<float>(operators.half_cotangent(t, i));
    }
    face_coefficient_(f, 3) = static_cast<float>(operators.face_area[t]);
  }
}

void HeatMethod::solve_block(std::span<const Source> sources, double* heat, float* distance,
                             float* out) const {
  const int32_t n = vertex_count();
  const size_t size = static_cast<size_t>(n) * lanes;
  const auto& row = heat_.permutation();
  std::fill(heat, heat + size, 0.0);
  for (int j = 0; j < lanes; ++j) {
    const Source& source = sources[std::min<size_t>(j, sources.size() - 1)];  // unused lanes repeat the last
    for (int i = 0; i < 3; ++i)
      heat[static_cast<size_t>(row[source.vertex[i]]) * lanes + j] += source.weight[i];
  }
  heat_.solve_block(heat);
  std::fill(distance, distance + size, 0.0f);
  const Faces faces{faces_.data(), face_coefficient_.data(), faces_.rows()};
  if (keep_negative_heat_)
    add_faces_signed(faces, heat, distance);
  else
    add_faces(faces, heat, distance);
  poisson_.solve_block(distance);
  float zero
      [lanes];  // the level that is distance 0: at the corners round a source it lies as far below as they are away
  for (int j = 0; j < lanes; ++j) {
    const Source& source = sources[std::min<size_t>(j, sources.size() - 1)];
    zero[j] = -source.corner_distance;
    for (int i = 0; i < 3; ++i)
      zero[j] += static_cast<float>(source.weight[i]) *
                 distance[static_cast<size_t>(row[source.vertex[i]]) * lanes + j];
  }
  for (int32_t v = 0; v < n; ++v) {
    const float* from = distance + static_cast<size_t>(row[v]) * lanes;
    for (int j = 0; j < lanes; ++j)
      out[static_cast<size_t>(v) * lanes + j] = std::max(from[j] - zero[j], 0.0f);
  }
}

void HeatMethod::run(std::span<const Source> sources, const Execution& execution,
                     const BlockSink& sink) const {
  const auto count = static_cast<int64_t>(sources.size());
  const size_t size = static_cast<size_t>(vertex_count()) * lanes;
  parallel_for(execution, (count + lanes - 1) / lanes, [&](int64_t block) {
    AlignedArray<double> heat(size);
    AlignedArray<float> distance(size), out(size);
    const int64_t first = block * lanes;
    const auto used = static_cast<int32_t>(std::min<int64_t>(lanes, count - first));
    solve_block(sources.subspan(first, used), heat.data(), distance.data(), out.data());
    sink(first, used, out.data());
  });
}

void HeatMethod::for_each_block(std::span<const SurfacePoint> points, const Execution& execution,
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
  }
  run(sources, execution, sink);
}

void HeatMethod::for_each_block(std::span<const int32_t> vertices, const Execution& execution,
                                const BlockSink& sink) const {
  std::vector<Source> sources(vertices.size());
  for (size_t s = 0; s < vertices.size(); ++s)
    sources[s] = {{vertices[s], vertices[s], vertices[s]}, {1, 0, 0}, 0};
  run(sources, execution, sink);
}

namespace {

HeatMethod::BlockSink into_rows(RowMatrixf& rows) {
  return [&rows](int64_t first, int32_t count, const float* distances) {
    for (Eigen::Index v = 0; v < rows.cols(); ++v)
      for (int32_t j = 0; j < count; ++j) rows(first + j, v) = distances[v * lanes + j];
  };
}

}  // namespace

RowMatrixf HeatMethod::distances(std::span<const SurfacePoint> sources, const Execution& execution) const {
  RowMatrixf result(sources.size(), vertex_count());
  for_each_block(sources, execution, into_rows(result));
  return result;
}

RowMatrixf HeatMethod::distances(std::span<const int32_t> source_vertices, const Execution& execution) const {
  RowMatrixf result(source_vertices.size(), vertex_count());
  for_each_block(source_vertices, execution, into_rows(result));
  return result;
}

}  // namespace focal
