// Triangular solves with the panels of a sparse Cholesky factor, 32 right-hand sides at a time: the inner
// loop of the analysis.
#pragma once
#include "linear/symbolic_factor.h"

namespace focal {

// G, P A P^T = G G^T, as computed by `factorise`.
template <class T>
struct Panels {
  const SymbolicFactor* symbolic;
  const T* values;
  const T* inverse_diagonal;
};

// Solves G G^T X = B in place; X[i * 32 + j] is row i of side j, in the order of the factor, 64-byte aligned.
void solve_panels(const Panels<double>& panels, double* X);
void solve_panels(const Panels<float>& panels, float* X);

}  // namespace focal
