// The solvers behind eigenbasis(): the smallest eigenpairs of A = M^-1/2 L M^-1/2, Phi orthonormal.
#pragma once
#include "spectrum/eigenbasis.h"

namespace focal {

// scale: a typical spacing of the wanted eigenvalues. A is singular, so the solvers factor A + shift I with a
// shift of that size: small enough for fast convergence, large enough to keep every digit of large
// eigenvalues.
struct StandardProblem {
  SparseMatrix A;
  double scale;
  int32_t count;
  double tolerance;                                          // relative residual
  std::shared_ptr<const SymbolicFactor> symbolic = nullptr;  // of A where it is known
  int32_t max_rounds = 40;                                   // of the Chebyshev iteration
};

// All eigenpairs at once, for matrices little larger than the count.
Eigenbasis dense_eigenpairs(const StandardProblem& problem);
// A + shift I.
SparseMatrix shifted(SparseMatrix A, double shift);

// One Krylov space with sequential solves, by Spectra: the reference, and the fallback of the next.
Eigenbasis lanczos_eigenpairs(const StandardProblem& problem, const Execution& execution);
// Blocks of 32 solves at once: fast. Throws not_converged after max_rounds.
Eigenbasis chebyshev_eigenpairs(const StandardProblem& problem, const Execution& execution);

}  // namespace focal
