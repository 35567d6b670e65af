// Converts the generalised problem to an ordinary one, A = M^-1/2 L M^-1/2, solves it, and converts the
// result back.
#include "spectrum/eigenbasis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numbers>

#include "base/error.h"
#include "spectrum/eigensolvers.h"

namespace focal {
namespace {

// A tenth of Weyl's law, lambda_k = 4 pi k / area, for the last wanted pair.
double eigenvalue_scale(double area, int32_t count) { return 0.4 * std::numbers::pi * count / area; }

Eigenbasis quick_eigenpairs(const StandardProblem& problem, const Execution& execution) {
  try {
    return chebyshev_eigenpairs(problem, execution);
  } catch (const Error& error) {
    if (error.status() != Status::not_converged) throw;
  }
  return lanczos_eigenpairs(problem, execution);
}

}  // namespace

SparseMatrix shifted(SparseMatrix A, double shift) {
  for (int32_t i = 0; i < A.rows(); ++i) A.coeffRef(i, i) += shift;
  return A;
}

void fix_sign(Eigen::Ref<Vector> phi) {
  Eigen::Index largest;
  phi.cwiseAbs().maxCoeff(&largest);
  if (phi(largest) < 0) phi = -phi;
}

Eigenbasis dense_eigenpairs(const StandardProblem& problem) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver{Matrix(problem.A)};
  if (solver.info() != Eigen::Success)
    throw Error(Status::not_converged, "the eigenvalues of the surface did not converge",
                "the mesh may hold non-finite positions or degenerate triangles; repair it first");
  return {solver.eigenvalues().head(problem.count), solver.eigenvectors().leftCols(problem.count)};
}

Eigenbasis eigenbasis(const SparseMatrix& L, const Vector& mass, const EigenParams& params,
                      const Execution& execution, std::shared_ptr<const SymbolicFactor> symbolic) {
  const auto n = static_cast<int32_t>(L.rows());
  if (n < 3) throw Error(Status::mesh_too_small, "a spectrum needs at least 3 vertices", "use a larger mesh");
  execution.check_cancelled();
  const int32_t count = std::clamp(params.count, 1, n - 2);
  const Vector inverse_root_mass = mass.cwiseSqrt().cwiseInverse();
  const StandardProblem problem{inverse_root_mass.asDiagonal() * L * inverse_root_mass.asDiagonal(),
                                eigenvalue_scale(mass.sum(), count),
                                count,
                                params.tolerance,
                                std::move(symbolic),
                                params.max_rounds};
  Eigenbasis basis = n < std::max(3 * count, 256)              ? dense_eigenpairs(problem)
                     : params.method == EigenMethod::chebyshev ? quick_eigenpairs(problem, execution)
                                                               : lanczos_eigenpairs(problem, execution);
  basis.lambda = basis.lambda.cwiseMax(0);
  parallel_for(execution, basis.Phi.cols(), [&](int64_t j) {
    basis.Phi.col(j).array() *= inverse_root_mass.array();
    fix_sign(basis.Phi.col(j));
  });
  execution.report(1);
  return basis;
}

}  // namespace focal
