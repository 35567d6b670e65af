// Subspace iteration in the shifted inverse, accelerated by Chebyshev polynomials (H. Rutishauser,
// "Computational aspects of F. L. Bauer's simultaneous iteration method", 1969; Y. Zhou, Y. Saad, M. Tiago,
// J. Chelikowsky, "Self-consistent-field calculations using Chebyshev-filtered subspace iteration", 2006).
// Solves are done 32 at a time, so each entry of the factor is read once for 32 columns; the first rounds in
// float, the last ones in double.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "spectrum/chebyshev_filter.h"
#include "spectrum/eigensolvers.h"
#include "spectrum/rayleigh_ritz.h"

namespace focal {
namespace {

constexpr int lanes = Columns::lanes;
constexpr int max_degree = 30;
constexpr double shift_over_last = 1;  // of the last column's eigenvalue: quick rounds without loss of rank

// Maximum growth of the first eigenvector relative to a column's own in one round: with more, float rounding
// noise along the first ones would dominate the others. On Ritz pairs noise is relative to the residual.
constexpr double first_lift = 1e3, random_lift = 1e7, ritz_lift = 1e9;

// The degrees of a round for each block: the remaining residual of its wanted columns, as gain to the
// tolerance. Columns beyond the wanted ones help most when they converge as fast as the last of those.
std::vector<int> choose_degrees(const Filter& filter, const Vector& residuals, double tolerance,
                                const Vector& lambda, int blocks) {
  const auto count = static_cast<int>(residuals.size());
  const double lift = ritz_lift / std::min(residuals.maxCoeff(), 1.0);
  std::vector<int> degrees(blocks);
  for (int b = 0; b < blocks; ++b) {
    const double rate = filter.rate(lambda(b * lanes + lanes - 1));
    const double allowed = std::log(lift) / std::max(filter.rate(0) - rate, 1e-3);
    double needed = b == 0 ? 0 : degrees[b - 1];
    for (int j = b * lanes; j < std::min(count, (b + 1) * lanes); ++j)
      if (residuals(j) > tolerance)
        needed =
            std::max(needed, 1 + std::ceil(filter.degree_to_grow(5 * residuals(j) / tolerance, lambda(j))));
    degrees[b] = static_cast<int>(std::min({needed, allowed, double{max_degree}}));
  }
  return degrees;
}

Columns random_columns(int64_t n, int blocks, const Execution& execution) {
  Columns X(n, blocks);
  parallel_for(execution, blocks, [&](int64_t b) {
    Random random(0, b);
    double* const column = X.block(static_cast<int>(b));
    for (int64_t i = 0; i < n * lanes; ++i) {
      if (i % (1 << 20) == 0) execution.check_cancelled();
      column[i] = random.uniform() - 0.5;
    }
  });
  return X;
}

// In two steps: after the first the columns are orthogonalised, so that they stay independent in float for
// longer.
void filter_random_columns(const Filter& filter, const ShiftedFactor& factor, const Columns& X,
                           const Execution& execution) {
  for (const double lift : {first_lift, random_lift}) {
    const auto degree = static_cast<int>(std::min<double>(max_degree, filter.degree_to_grow(lift, 0)));
    parallel_for(execution, X.blocks, [&](int64_t b) {
      filter_random(filter, std::max(degree, 2), factor, X.block(static_cast<int>(b)), execution);
    });
    if (lift == first_lift) orthonormalise_roughly(X, execution);
  }
}

void filter_columns(const Filter& filter, const ShiftedFactor& factor, const std::vector<int>& degrees,
                    const Vector& lambda, const Columns& X, bool in_float, const Execution& execution) {
  parallel_for(execution, X.blocks, [&](int64_t i) {
    const int b = X.blocks - 1 - static_cast<int>(i);  // the longest first
    if (degrees[b] > 0)
      filter_ritz_pairs(filter, degrees[b], factor, lambda.data() + b * lanes, X.block(b), in_float,
                        execution);
  });
}

double norm_bound(const SparseMatrix& A) {
  double largest = 0;
  for (int32_t j = 0; j < A.cols(); ++j) largest = std::max(largest, A.col(j).cwiseAbs().sum());
  return largest;
}

// The first shift follows Weyl's law, but thin shapes have eigenvalues far above it, and a surface of many
// parts has many near zero. Much too small a shift drowns the last columns in rounding noise; much too large
// a shift cannot separate them.
void follow_spectrum(ShiftedFactor& factor, const StandardProblem& problem, double last,
                     const Execution& execution) {
  const double shift = std::max(shift_over_last * last, 1e-2 * problem.scale);
  if (shift > 5 * factor.shift || 5 * shift < factor.shift)
    factor = factor.with_shift(problem.A, shift, execution);
}

// |A x - lambda x| / lambda of the wanted pairs. The zero eigenvalue is measured relative to a thousandth of
// the shift; and no residual can be smaller than the rounding error of A x, which limits the accuracy on
// slivers.
class Convergence {
 public:
  Convergence(const SparseMatrix& A, double tolerance)
      : tolerance_(tolerance), rounding_(30 * std::numeric_limits<double>::epsilon() * norm_bound(A)) {}
  Vector residuals(const Vector& norms, const Vector& lambda, double shift, int count) const {
    const auto size = lambda.array().max(1e-3 * shift) + rounding_ / tolerance_;
    return (norms.array() / size).head(count);
  }

 private:
  double tolerance_, rounding_;
};

}  // namespace

Eigenbasis chebyshev_eigenpairs(const StandardProblem& problem, const Execution& execution) {
  const auto n = static_cast<int32_t>(problem.A.rows());
  const int count = problem.count;
  // The convergence rate is the ratio of the last wanted to the first dropped eigenvalue: keep a quarter more
  // than wanted.
  const int blocks = (count + count / 5 + 16 + lanes - 1) / lanes;
  const double columns_per_wanted = static_cast<double>(blocks * lanes) / count;
  // The best current estimate of the last column's eigenvalue.
  double last = 10 * problem.scale * columns_per_wanted;
  ShiftedFactor factor(problem.A, shift_over_last * last, problem.symbolic, execution);
  const Columns X = random_columns(n, blocks, execution);
  const Convergence convergence(problem.A, problem.tolerance);
  Vector lambda, residuals;
  double residual = 1, previous = 1;
  for (int round = 0; !(residual <= problem.tolerance); ++round) {
    if (round == problem.max_rounds || !std::isfinite(residual))
      throw Error(Status::not_converged, "the eigenvalues of the surface did not converge",
                  "ask for fewer eigenpairs, or repair the mesh first");
    if (round > 1) follow_spectrum(factor, problem, lambda(lambda.size() - 1), execution);
    const Filter filter{1 / (last + factor.shift), factor.shift};
    // Float solves as long as they reduce the residual; double ones where A is too ill-conditioned for float.
    const bool in_float = round <= 1 || residual < 0.1 * previous;
    if (round == 0) {
      filter_random_columns(filter, factor, X, execution);
      lambda = rough_rayleigh_ritz(factor.A, X, execution);
    } else {
      const auto degrees = choose_degrees(filter, residuals, problem.tolerance, lambda, blocks);
      filter_columns(filter, factor, degrees, lambda, X, in_float, execution);
      // Blocks that had converged may be locked once a precise round has orthogonalised them.
      const auto converged = round == 1 ? 0 : std::count(degrees.begin(), degrees.end(), 0);
      lambda = rayleigh_ritz(factor.A, X, lambda.head(converged * lanes).eval(), execution);
    }
    residuals =
        convergence.residuals(residual_norms(factor.A, X, lambda, execution), lambda, factor.shift, count);
    previous = std::exchange(residual, residuals.maxCoeff());
    // Early on the last columns are mostly noise; and a surface of many parts has many zero eigenvalues.
    last = std::min(lambda(lambda.size() - 1), 1.05 * columns_per_wanted * lambda(count - 1));
    last = std::max(last, 0.2 * factor.shift);
    execution.report(1 - std::pow(0.5, round + 1));
  }
  Eigenbasis basis{lambda.head(count), Matrix(n, count)};
  const auto& order = factor.cholesky.permutation();
  parallel_for(execution, count, [&](int64_t j) {
    for (int32_t i = 0; i < n; ++i) basis.Phi(i, j) = X(order[i], static_cast<int>(j));
  });
  return basis;
}

}  // namespace focal
