#include "geodesics/greens_distance.h"

#include <algorithm>
#include <cmath>

#include "base/aligned_array.h"

namespace focal {
namespace {

// Shift of the Laplacian, in units of 1 / area: makes it definite even with slivers, and is far below its
// other eigenvalues.
constexpr double shift = 1e-6;

SparseMatrix shifted(SparseMatrix L, const Operators& operators) {
  for (int32_t i = 0; i < L.rows(); ++i) L.coeffRef(i, i) += shift / operators.area * operators.mass[i];
  return L;
}

class GreensDistance final : public Distance {
 public:
  GreensDistance(const MeasuredSurface& surface, int solves, const Execution& execution)
      : Distance(surface.mesh),
        solves_(solves),
        factor_(shifted(surface.operators.L, surface.operators), execution),
        mass_(surface.operators.mass),
        area_(surface.operators.mass.sum()),
        own_(surface.mesh.vertex_count()) {
    const int32_t n = vertex_count();
    parallel_for(execution, (n + lanes - 1) / lanes, [&](int64_t block) {
      const auto first = static_cast<int32_t>(block) * lanes, count = std::min(lanes, n - first);
      std::vector<Source> sources;
      for (int32_t v = first; v < first + count; ++v) sources.push_back({{v, v, v}, {1, 0, 0}});
      const AlignedArray<double> G = columns(sources, execution);
      for (int32_t j = 0; j < count; ++j) own_[first + j] = at(G, first + j, j);
    });
    distance_bound_ = 2 * std::sqrt(std::max(own_.maxCoeff(), 0.0));  // G is positive semi-definite
  }
  std::shared_ptr<const SymbolicFactor> symbolic() const override { return factor_.symbolic(); }

 private:
  double& at(const AlignedArray<double>& G, int32_t vertex, size_t j) const {
    return G.data()[static_cast<size_t>(factor_.permutation()[vertex]) * lanes + j];
  }

  // Subtracts from each lane its mean over the surface. is_density: values per vertex; else integrals around
  // it, as L returns.
  void centre(const AlignedArray<double>& values, bool is_density) const {
    double mean[lanes] = {};
    for (int32_t v = 0; v < vertex_count(); ++v)
      for (int j = 0; j < lanes; ++j) mean[j] += (is_density ? mass_[v] : 1) * at(values, v, j) / area_;
    for (int32_t v = 0; v < vertex_count(); ++v)
      for (int j = 0; j < lanes; ++j) at(values, v, j) -= (is_density ? 1 : mass_[v]) * mean[j];
  }

  // Columns of G for the sources.
  AlignedArray<double> columns(std::span<const Source> sources, const Execution& execution) const {
    AlignedArray<double> G(static_cast<size_t>(vertex_count()) * lanes);
    std::fill_n(G.data(), G.size(), 0.0);
    for (size_t j = 0; j < sources.size(); ++j)
      for (int i = 0; i < 3; ++i) at(G, sources[j].vertex[i], j) += sources[j].weight[i];
    centre(G, false);
    for (int solve = 0; solve < solves_; ++solve) {
      if (solve > 0)
        for (int32_t v = 0; v < vertex_count(); ++v)
          for (int j = 0; j < lanes; ++j) at(G, v, j) *= mass_[v];
      execution.check_cancelled();
      factor_.solve_block(G.data());
      centre(G, true);
    }
    return G;
  }

  void solve_block(std::span<const Source> sources, float* out, const Execution& execution) const override {
    const AlignedArray<double> G = columns(sources, execution);
    double own[lanes] = {};
    for (size_t j = 0; j < sources.size(); ++j)
      for (int i = 0; i < 3; ++i) own[j] += sources[j].weight[i] * at(G, sources[j].vertex[i], j);
    for (int32_t v = 0; v < vertex_count(); ++v)
      for (size_t j = 0; j < lanes; ++j)
        out[static_cast<size_t>(v) * lanes + j] =
            static_cast<float>(std::sqrt(std::max(own_[v] + own[j] - 2 * at(G, v, j), 0.0)));
  }

  int solves_;
  SparseCholesky factor_;
  Vector mass_;
  double area_;
  Vector own_;  // G(v, v)
};

}  // namespace

std::shared_ptr<const Distance> greens_distance(const MeasuredSurface& surface, int solves,
                                                const Execution& execution) {
  return std::make_shared<GreensDistance>(surface, solves, execution);
}

}  // namespace focal
