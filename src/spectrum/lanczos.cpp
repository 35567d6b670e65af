// Implicitly restarted Lanczos by Spectra (D. Sorensen, "Implicit Application of Polynomial Filters in a
// k-Step Arnoldi Method", 1992) in the shifted inverse.
#include <Spectra/SymEigsSolver.h>

#include <algorithm>

#include "base/error.h"
#include "linear/sparse_cholesky.h"
#include "spectrum/eigensolvers.h"

namespace focal {
namespace {

SparseMatrix shifted(SparseMatrix A, double shift) {
  for (int32_t i = 0; i < A.rows(); ++i) A.coeffRef(i, i) += shift;
  return A;
}

// y = (A + shift I)^-1 x, in the interface that Spectra requires.
class ShiftedInverse {
 public:
  using Scalar = double;
  ShiftedInverse(const SparseMatrix& A, double shift, int32_t expected_solves, const Execution& execution)
      : cholesky_(shifted(A, shift)), expected_solves_(expected_solves), execution_(execution) {}
  Eigen::Index rows() const { return cholesky_.size(); }
  Eigen::Index cols() const { return cholesky_.size(); }
  void perform_op(const double* x, double* y) const {
    execution_.check_cancelled();
    execution_.report(std::min(0.95, double(++solves_) / expected_solves_));
    Eigen::Map<Vector>(y, rows()) = cholesky_.solve(Eigen::Map<const Vector>(x, rows()));
  }

 private:
  SparseCholesky cholesky_;
  int32_t expected_solves_;
  mutable int32_t solves_ = 0;
  const Execution& execution_;
};

}  // namespace

Eigenbasis lanczos_eigenpairs(const StandardProblem& problem, const Execution& execution) {
  const auto n = static_cast<int32_t>(problem.A.rows());
  const int32_t space = std::min(n, problem.count + problem.count / 2 + 20);
  const double shift = problem.scale;
  ShiftedInverse inverse(problem.A, shift, 3 * space, execution);
  Spectra::SymEigsSolver<ShiftedInverse> solver(inverse, problem.count, space);
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge, 1000, 0.01 * problem.tolerance);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw Error(Status::not_converged, "the eigenvalues of the surface did not converge",
                "ask for fewer eigenpairs, or repair the mesh first");
  return {solver.eigenvalues().cwiseInverse().array() - shift, solver.eigenvectors()};
}

}  // namespace focal
