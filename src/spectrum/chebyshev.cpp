// Subspace iteration in the shifted inverse, sharpened by Chebyshev polynomials (H. Rutishauser,
// "Computational aspects of F. L. Bauer's simultaneous iteration method", 1969; Y. Zhou, Y. Saad, M. Tiago,
// J. Chelikowsky, "Self-consistent- field calculations using Chebyshev-filtered subspace iteration", 2006).
// All solves are made 32 at a time, so each entry of the factor is read once for 32 columns; the first rounds
// in float, the last ones in double.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/random.h"
#include "spectrum/eigensolvers.h"
#include "spectrum/rayleigh_ritz.h"

namespace focal {
namespace {

constexpr int lanes = Columns::lanes;
constexpr int max_rounds = 40, min_degree = 3, max_degree = 12;
constexpr double shift_over_last = 0.5;  // of the last column's eigenvalue: quick rounds without loss of rank

// A + shift I, factored; A in the order of the factor, which does not depend on the shift.
struct ShiftedFactor {
  double shift;
  SparseCholesky cholesky;
  SparseMatrix A;

  ShiftedFactor(const SparseMatrix& original, double shift_) : shift(shift_) {
    SparseMatrix shifted = original;
    for (int32_t i = 0; i < shifted.rows(); ++i) shifted.coeffRef(i, i) += shift;
    cholesky = SparseCholesky(shifted);
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int32_t> order(cholesky.size());
    std::copy(cholesky.permutation().begin(), cholesky.permutation().end(), order.indices().data());
    A = original.twistedBy(order);
  }
};

// T_degree(2 nu / cut - 1), nu = 1 / (lambda + shift): at most 1 for nu below the cut, growing fast above.
struct Filter {
  double cut;
  int degree;
  bool in_float;
};

// Eigenvalues that shape the filter, as well as they are known: the last wanted one and that of the last
// column.
struct Bounds {
  double wanted, last;
};

// How much a round may lift the first eigenvector over the last column's: more, and rounding noise along the
// first ones would drown the rest. Random columns hold all directions alike; later ones are already near
// their own.
double growth_limit(int round) { return round == 0 ? 1e7 : round == 1 ? 1e9 : 1e13; }

// gain: what is missing to the tolerance.
Filter choose_filter(int round, const Bounds& bounds, double shift, double gain) {
  const double cut = 1 / (bounds.last + shift);
  const auto degree_to_reach = [&](double growth, double lambda) {
    const double x = 2 / (cut * (lambda + shift)) - 1;
    return std::acosh(std::max(growth, 1.0)) / std::acosh(std::max(x, 1.001));
  };
  const double allowed = std::min<double>(max_degree, degree_to_reach(growth_limit(round), 0));
  const double needed = round < 2 ? max_degree : degree_to_reach(2 * gain, bounds.wanted);
  const int degree = std::max(min_degree, static_cast<int>(std::min(allowed, std::ceil(needed))));
  return {cut, degree, round < 2};
}

template <class T>
void apply(const Filter& filter, const SparseCholesky& cholesky, double* block, const Execution& execution) {
  const size_t size = static_cast<size_t>(cholesky.size()) * lanes;
  const AlignedArray<T> buffers[3] = {AlignedArray<T>(size), AlignedArray<T>(size), AlignedArray<T>(size)};
  T *previous = buffers[0].data(), *current = buffers[1].data(), *next = buffers[2].data();
  std::copy_n(block, size, current);
  const T two_over_cut = static_cast<T>(2 / filter.cut);
  for (int k = 0; k < filter.degree; ++k) {
    execution.check_cancelled();
    std::copy_n(current, size, next);
    cholesky.solve_block(next);
    if (k == 0)
      for (size_t i = 0; i < size; ++i) next[i] = two_over_cut * next[i] - current[i];
    else
      for (size_t i = 0; i < size; ++i) next[i] = 2 * (two_over_cut * next[i] - current[i]) - previous[i];
    std::swap(previous, current), std::swap(current, next);
  }
  std::copy_n(current, size, block);
}

void apply(const Filter& filter, const SparseCholesky& cholesky, const Columns& X,
           const Execution& execution) {
  parallel_for(execution, X.blocks, [&](int64_t b) {
    double* block = X.block(static_cast<int>(b));
    if (filter.in_float)
      apply<float>(filter, cholesky, block, execution);
    else
      apply<double>(filter, cholesky, block, execution);
  });
}

Columns random_columns(int64_t n, int blocks, const Execution& execution) {
  Columns X(n, blocks);
  parallel_for(execution, blocks, [&](int64_t b) {
    Random random(0, b);
    std::generate_n(X.block(static_cast<int>(b)), n * lanes, [&] { return random.uniform() - 0.5; });
  });
  return X;
}

double norm_bound(const SparseMatrix& A) {
  double largest = 0;
  for (int32_t j = 0; j < A.cols(); ++j) largest = std::max(largest, A.col(j).cwiseAbs().sum());
  return largest;
}

// The first shift follows Weyl's law, but needles have eigenvalues far above it, and a surface in many parts
// has many near zero: a shift far too small drowns the last columns in rounding noise, one far too large
// cannot tell them apart.
void follow_spectrum(std::optional<ShiftedFactor>& factor, const StandardProblem& problem, double last) {
  const double shift = std::max(shift_over_last * last, 1e-2 * problem.scale);
  if (shift > 5 * factor->shift || 5 * shift < factor->shift) factor.emplace(problem.A, shift);
}

// Largest |A x - lambda x| / lambda of the wanted pairs. The zero eigenvalue is weighed against a thousandth
// of the shift; and no residual can be smaller than the rounding of A x, which on slivers is all there is to
// reach.
class Convergence {
 public:
  Convergence(const SparseMatrix& A, double tolerance)
      : tolerance_(tolerance), rounding_(30 * std::numeric_limits<double>::epsilon() * norm_bound(A)) {}
  double residual(const Vector& norms, const Vector& lambda, double shift, int count) const {
    const auto size = lambda.array().max(1e-3 * shift) + rounding_ / tolerance_;
    return (norms.array() / size).head(count).maxCoeff();
  }

 private:
  double tolerance_, rounding_;
};

}  // namespace

Eigenbasis chebyshev_eigenpairs(const StandardProblem& problem, const Execution& execution) {
  const auto n = static_cast<int32_t>(problem.A.rows());
  const int count = problem.count;
  // Rounds converge at the ratio of the last wanted to the first dropped eigenvalue: keep a quarter more than
  // wanted.
  const int blocks = (count + count / 5 + 16 + lanes - 1) / lanes;
  const double columns_per_wanted = static_cast<double>(blocks * lanes) / count;
  Bounds bounds{10 * problem.scale, 10 * problem.scale * columns_per_wanted};
  std::optional<ShiftedFactor> factor(std::in_place, problem.A, shift_over_last * bounds.last);
  const Columns X = random_columns(n, blocks, execution);
  const Convergence convergence(problem.A, problem.tolerance);
  Vector lambda;
  double residual = 1;
  for (int round = 0; !(residual <= problem.tolerance); ++round) {
    if (round == max_rounds || !std::isfinite(residual))
      throw Error(Status::not_converged, "the eigenvalues of the surface did not converge",
                  "ask for fewer eigenpairs, or repair the mesh first");
    if (round > 1) follow_spectrum(factor, problem, lambda(lambda.size() - 1));
    apply(choose_filter(round, bounds, factor->shift, residual / problem.tolerance), factor->cholesky, X,
          execution);
    lambda = rayleigh_ritz(factor->A, X, execution);
    const Vector norms = residual_norms(factor->A, X, lambda, execution);
    residual = convergence.residual(norms, lambda, factor->shift, count);
    bounds.wanted = lambda(count - 1);
    // Early on the last columns hold little but noise; and many separate parts have many zero eigenvalues.
    bounds.last = std::min(lambda(lambda.size() - 1), 1.05 * columns_per_wanted * bounds.wanted);
    bounds.last = std::max(bounds.last, factor->shift);
    execution.report(1 - std::pow(0.5, round + 1));
  }
  Eigenbasis basis{lambda.head(count), Matrix(n, count)};
  for (int j = 0; j < count; ++j)
    for (int32_t i = 0; i < n; ++i) basis.Phi(i, j) = X(factor->cholesky.permutation()[i], j);
  return basis;
}

}  // namespace focal
