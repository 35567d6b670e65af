#include "geodesics/heat_method.h"

#include <algorithm>
#include <cmath>

#include "base/aligned_array.h"
#include "base/error.h"
#include "base/multiversion.h"

namespace focal {
namespace {

constexpr int lanes = HeatMethod::lanes;

// Heat decays like exp(-d / sqrt(t)); the smallest double is about exp(-700).
constexpr double representable_decay = 650;

SparseMatrix plus_diagonal(SparseMatrix A, const Vector& diagonal) {
  for (int32_t i = 0; i < A.rows(); ++i) A.coeffRef(i, i) += diagonal[i];
  return A;
}

// Right-hand side of the Poisson equation, for all triangles and lanes. With the heat u, the triangle's
// Laplacian L_f and the gradient g, X = -g / |g| has the integrated divergence L_f u / |g| at the corners, so
// no 3D vector is formed; and |g|^2 = u^T L_f u / area. u is first divided by its largest corner, which keeps
// tiny values far away exact.
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
      // u^T L_f u
      const float energy = c0 * d[0][j] * d[0][j] + c1 * d[1][j] * d[1][j] + c2 * d[2][j] * d[2][j];
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
                       bool keep_negative_heat, std::span<const std::pair<int32_t, int32_t>> bridges)
    : Distance(mesh), keep_negative_heat_(keep_negative_heat) {
  execution.check_cancelled();
  const auto symbolic = std::make_shared<const SymbolicFactor>(analyse_pattern(operators.L, {}, execution));
  parallel_for(execution, 2, [&](int64_t part) {
    if (part == 0) {
      time_ = heat_time(mesh, operators);
      distance_bound_ = time_.distance_bound;
      heat_ = SparseCholesky(plus_diagonal(time_.t * operators.L, operators.mass), symbolic, execution);
    } else {
      // The shift makes L definite. It amplifies the constant mode by its inverse: with 1e-6 the float solve keeps
      // five digits.
      poisson_ = SparseCholesky(plus_diagonal(operators.L, 1e-6 / operators.area * operators.mass), symbolic,
                                execution);
    }
  });
  execution.check_cancelled();
  sort_faces(operators);
  const auto& row = heat_.permutation();
  for (const auto& [a, b] : bridges)
    bridges_.push_back(
        {row[a], row[b], static_cast<float>((mesh.positions.row(a) - mesh.positions.row(b)).norm())});
}

// A bridge is an edge of weight 1 in L along which distance increases by the gap, away from the heat.
void HeatMethod::add_bridges(const double* heat, float* rhs) const {
  for (const Bridge& bridge : bridges_)
    for (int j = 0; j < lanes; ++j) {
      const int64_t from = int64_t{bridge.from} * lanes + j, to = int64_t{bridge.to} * lanes + j;
      const float length = heat[from] > heat[to]   ? bridge.length
                           : heat[from] < heat[to] ? -bridge.length
                                                   : 0.0f;
      rhs[from] -= length, rhs[to] += length;
    }
}

HeatTime heat_time(const TriangleMesh& mesh, const Operators& operators) {
  const double step = operators.mean_edge;
  const double bound = diameter_bound(mesh, operators.L), smallest = bound / representable_decay;
  return {std::pow(std::max(step, smallest), 2), bound, smallest > step};
}

void HeatMethod::sort_faces(const Operators& operators) {
  const auto& permutation = heat_.permutation();
  const MatrixX3i& triangles = operators.triangles;
  const auto m = static_cast<int32_t>(triangles.rows());
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

void HeatMethod::solve_block(std::span<const Source> sources, float* out, const Execution& execution) const {
  const int32_t n = vertex_count();
  const size_t size = static_cast<size_t>(n) * lanes;
  const auto& row = heat_.permutation();
  const AlignedArray<double> heat_values(size);
  const AlignedArray<float> poisson_values(size);
  double* heat = heat_values.data();
  float* distance = poisson_values.data();
  std::fill(heat, heat + size, 0.0);
  for (int j = 0; j < lanes; ++j) {
    const Source& source = sources[std::min<size_t>(j, sources.size() - 1)];  // unused lanes repeat the last
    for (int i = 0; i < 3; ++i)
      heat[static_cast<size_t>(row[source.vertex[i]]) * lanes + j] += source.weight[i];
  }
  heat_.solve_block(heat);
  execution.check_cancelled();
  std::fill(distance, distance + size, 0.0f);
  const Faces faces{faces_.data(), face_coefficient_.data(), faces_.rows()};
  if (keep_negative_heat_)
    add_faces_signed(faces, heat, distance);
  else
    add_faces(faces, heat, distance);
  add_bridges(heat, distance);
  execution.check_cancelled();
  poisson_.solve_block(distance);
  execution.check_cancelled();
  // The value that corresponds to distance 0: at the corners around a source it is lower by their distance.
  float zero[lanes];
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

DistanceKind heat_distance() {
  return {"heat", true, true,
          [](const MeasuredSurface& surface, const Execution& execution) -> std::shared_ptr<const Distance> {
            return std::make_shared<HeatMethod>(surface.mesh, surface.operators, execution,
                                                surface.paper_exact, surface.bridges);
          }};
}

}  // namespace focal
