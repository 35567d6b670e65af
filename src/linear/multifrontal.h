// The numerical values of a sparse Cholesky factor.
#pragma once
#include <vector>

#include "base/parallel.h"
#include "linear/symbolic_factor.h"

namespace focal {

// The panels of G, P A P^T = G G^T (see SymbolicFactor). Only the lower triangle of A is read; it may have
// fewer entries than the matrix that was analysed. Throws not_converged when A is not positive definite.
std::vector<double> factorise(const SymbolicFactor& symbolic, const SparseMatrix& A,
                              const Execution& execution);

}  // namespace focal
