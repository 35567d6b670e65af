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
  std::shared_ptr<const SymbolicFactor> symbolic = nullptr;  // of A if known
};

// All eigenpairs at once, for matrices little larger than the count.
Eigenbasis dense_eigenpairs(const StandardProblem& problem);
// One Krylov space with sequential solves: the reference.
Eigenbasis lanczos_eigenpairs(const StandardProblem& problem, const Execution& execution);
// Blocks of 32 solves at once: fast.
Eigenbasis chebyshev_eigenpairs(const StandardProblem& problem, const Execution& execution);

}  // namespace focal
