#include "spectrum/chebyshev_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/aligned_array.h"
#include "base/multiversion.h"
#include "linear/block_kernels.h"
#include "spectrum/eigensolvers.h"

namespace focal {
namespace {

constexpr int lanes = SparseCholesky::lanes;

template <class T>
struct Buffers {
  AlignedArray<T> previous, current, next, source;
  explicit Buffers(size_t size) : previous(size), current(size), next(size), source(size) {}
};

// next <- 2 (scale next - current) - previous + weight[lane] source.
template <class T>
FOCAL_INLINE void recur_body(T scale, const T* weight, const T* previous, const T* current, const T* source,
                             T* next, int64_t n) {
  for (int64_t i = 0; i < n * lanes; i += lanes)
    for (int j = 0; j < lanes; ++j)
      next[i + j] = 2 * (scale * next[i + j] - current[i + j]) - previous[i + j] + weight[j] * source[i + j];
}
FOCAL_MULTIVERSION(void recur(float scale, const float* weight, const float* previous, const float* current,
                              const float* source, float* next, int64_t n),
                   recur_body(scale, weight, previous, current, source, next, n);)
FOCAL_MULTIVERSION(void recur(double scale, const double* weight, const double* previous,
                              const double* current, const double* source, double* next, int64_t n),
                   recur_body(scale, weight, previous, current, source, next, n);)

// Later rounds, on Ritz pairs: with t the filter's argument at the Ritz value and r = A x - lambda x, d_k =
// T_k x - T_k(t) x follows the same recurrence with a source of the size of r. So rounding errors are
// relative to the residual, not to x, and float solves suffice: x <- x + d_degree / T_degree(t).
template <class T>
void correct(const Filter& filter, int degree, const ShiftedFactor& factor, const double* lambda,
             double* block, const Execution& execution) {
  const int64_t n = factor.cholesky.size();
  const size_t size = static_cast<size_t>(n) * lanes;
  Buffers<T> f(size);
  double t[lanes], chebyshev[lanes], before[lanes];  // T_k(t) and T_k-1(t)
  T weight[lanes];
  constexpr int64_t chunk = 64;
  const AlignedArray<double> product(chunk * lanes);
  for (int j = 0; j < lanes; ++j) t[j] = chebyshev[j] = filter.argument(lambda[j]), before[j] = 1;
  for (int64_t begin = 0; begin < n; begin += chunk) {
    const int64_t end = std::min(n, begin + chunk);
    multiply_rows(factor.A, begin, end, block, product.data());
    for (int64_t i = begin; i < end; ++i)
      for (int j = 0; j < lanes; ++j)
        f.source.data()[i * lanes + j] = static_cast<T>(
            -(t[j] + 1) * (product.data()[(i - begin) * lanes + j] - lambda[j] * block[i * lanes + j]));
  }
  factor.cholesky.solve_block(f.source.data());
  std::copy_n(f.source.data(), size, f.current.data());
  std::fill_n(f.previous.data(), size, T{0});
  for (int k = 2; k < degree; ++k) {
    execution.check_cancelled();
    std::copy_n(f.current.data(), size, f.next.data());
    factor.cholesky.solve_block(f.next.data());
    for (int j = 0; j < lanes; ++j) weight[j] = static_cast<T>(2 * chebyshev[j]);
    recur(static_cast<T>(2 / filter.cut), weight, f.previous.data(), f.current.data(), f.source.data(),
          f.next.data(), n);
    std::swap(f.previous, f.current), std::swap(f.current, f.next);
    for (int j = 0; j < lanes; ++j)
      before[j] = std::exchange(chebyshev[j], 2 * t[j] * chebyshev[j] - before[j]);
  }
  execution.check_cancelled();
  factor.cholesky.solve_block(f.current.data());
  for (int64_t i = 0; i < n; ++i)
    for (int j = 0; j < lanes; ++j) {
      const double grown = std::max(std::abs(chebyshev[j]), 1.0);  // above the cut T may vanish: x shrinks
      const double own = block[i * lanes + j] + f.source.data()[i * lanes + j] / (t[j] + 1);
      block[i * lanes + j] =
          (chebyshev[j] * own + (lambda[j] + filter.shift) * f.current.data()[i * lanes + j]) / grown;
    }
}

}  // namespace

ShiftedFactor::ShiftedFactor(const SparseMatrix& original, double shift_,
                             std::shared_ptr<const SymbolicFactor> symbolic, const Execution& execution)
    : shift(shift_),
      cholesky(symbolic ? SparseCholesky(shifted(original, shift), std::move(symbolic), execution)
                        : SparseCholesky(shifted(original, shift), execution)) {
  execution.check_cancelled();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int32_t> order(cholesky.size());
  std::copy(cholesky.permutation().begin(), cholesky.permutation().end(), order.indices().data());
  A = original.twistedBy(order);
}

ShiftedFactor ShiftedFactor::with_shift(const SparseMatrix& original, double other,
                                        const Execution& execution) const {
  ShiftedFactor factor = *this;
  factor.shift = other;
  factor.cholesky = SparseCholesky(shifted(original, other), cholesky, execution);
  return factor;
}

double Filter::rate(double lambda) const { return std::acosh(std::max(argument(lambda), 1.0001)); }

double Filter::degree_to_grow(double growth, double lambda) const {
  return std::acosh(std::max(growth, 1.0)) / rate(lambda);
}

void filter_random(const Filter& filter, int degree, const ShiftedFactor& factor, double* block,
                   const Execution& execution) {
  const SparseCholesky& cholesky = factor.cholesky;
  const size_t size = static_cast<size_t>(cholesky.size()) * lanes;
  Buffers<float> f(size);
  const float none[lanes] = {};
  const auto scale = static_cast<float>(2 / filter.cut);
  std::copy_n(block, size, f.current.data());
  for (int k = 0; k < degree; ++k) {
    execution.check_cancelled();
    std::copy_n(f.current.data(), size, f.next.data());
    cholesky.solve_block(f.next.data());
    if (k == degree - 1)
      ;
    else if (k == 0)
      for (size_t i = 0; i < size; ++i) f.next.data()[i] = scale * f.next.data()[i] - f.current.data()[i];
    else
      recur(scale, none, f.previous.data(), f.current.data(), f.current.data(), f.next.data(),
            cholesky.size());
    std::swap(f.previous, f.current), std::swap(f.current, f.next);
  }
  std::copy_n(f.current.data(), size, block);
}

void filter_ritz_pairs(const Filter& filter, int degree, const ShiftedFactor& factor, const double* lambda,
                       double* block, bool in_float, const Execution& execution) {
  if (in_float)
    correct<float>(filter, degree, factor, lambda, block, execution);
  else
    correct<double>(filter, degree, factor, lambda, block, execution);
}

}  // namespace focal
