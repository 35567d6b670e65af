// Chebyshev polynomials of the shifted inverse, applied to 32 columns at a time.
#pragma once
#include "base/parallel.h"
#include "linear/sparse_cholesky.h"

namespace focal {

// A + shift I, factored; A is in the order of the factor, which does not depend on the shift.
struct ShiftedFactor {
  double shift;
  SparseCholesky cholesky;
  SparseMatrix A;

  // symbolic: the symbolic analysis of the matrix if known, or null.
  ShiftedFactor(const SparseMatrix& original, double shift, std::shared_ptr<const SymbolicFactor> symbolic,
                const Execution& execution);
  // The same matrix with another shift.
  ShiftedFactor with_shift(const SparseMatrix& original, double shift, const Execution& execution) const;
};

// T_degree(2 nu / cut - 1), nu = 1 / (lambda + shift): at most 1 for nu below the cut, growing fast above.
struct Filter {
  double cut, shift;

  double argument(double lambda) const { return 2 / (cut * (lambda + shift)) - 1; }
  // The degree at which the filter grows by this factor at lambda, and its logarithmic growth per degree.
  double degree_to_grow(double growth, double lambda) const;
  double rate(double lambda) const;
};

// The first round, on random columns: x <- T_degree x, in float.
void filter_random(const Filter& filter, int degree, const ShiftedFactor& factor, double* block,
                   const Execution& execution);

// Later rounds, on Ritz pairs (lambda, x): x <- T_degree x / T_degree(argument(lambda)), with float or double
// solves. Both are exact for x that are eigenvectors.
void filter_ritz_pairs(const Filter& filter, int degree, const ShiftedFactor& factor, const double* lambda,
                       double* block, bool in_float, const Execution& execution);

}  // namespace focal
