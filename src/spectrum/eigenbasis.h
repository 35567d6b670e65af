// The k smallest eigenpairs of L phi = lambda M phi.
#pragma once
#include <memory>

#include "base/matrix.h"
#include "base/parallel.h"
#include "linear/symbolic_factor.h"

namespace focal {

struct Eigenbasis {
  Vector lambda;  // k, ascending, >= 0; lambda(0) = 0 on a connected surface. Unit 1 / area
  Matrix Phi;     // n x k, Phi^T M Phi = I
};

// chebyshev: blocks of solves, threaded, finds repeated eigenvalues; falls back to spectra if it does not
// converge. spectra: sequential solves, as a reference.
enum class EigenMethod { spectra, chebyshev };

struct EigenParams {
  int32_t count = 200;  // clamped to n - 2
  EigenMethod method = EigenMethod::chebyshev;
  double tolerance = 1e-8;  // relative residual; the error of an eigenvalue is about its square
  int32_t max_rounds = 40;  // of chebyshev; it needs 3 to 6
};

// L: n x n symmetric positive semi-definite; mass: n, > 0 (the diagonal of M). The same bits for any number
// of threads. Each eigenvector's entry of largest magnitude is positive. Throws mesh_too_small (n < 3),
// not_converged, cancelled. Cost of 200 pairs at 12,500 vertices: chebyshev 0.7 s on one core, spectra 4 s.
// symbolic: the symbolic analysis of L if known, or null.
Eigenbasis eigenbasis(const SparseMatrix& L, const Vector& mass, const EigenParams& params,
                      const Execution& execution, std::shared_ptr<const SymbolicFactor> symbolic = nullptr);

// The sign of an eigenvector is arbitrary: makes the entry of largest magnitude positive.
void fix_sign(Eigen::Ref<Vector> phi);

}  // namespace focal
