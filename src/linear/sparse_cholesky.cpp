#include "linear/sparse_cholesky.h"

#include "linear/multifrontal.h"
#include "linear/panel_solve.h"

namespace focal {

SparseCholesky::SparseCholesky(const SparseMatrix& A, const Execution& execution)
    : SparseCholesky(A, std::make_shared<const SymbolicFactor>(analyse_pattern(A, {}, execution)),
                     execution) {}

SparseCholesky::SparseCholesky(const SparseMatrix& A, const SparseCholesky& same_pattern,
                               const Execution& execution)
    : SparseCholesky(A, same_pattern.symbolic_, execution) {}

SparseCholesky::SparseCholesky(const SparseMatrix& A, std::shared_ptr<const SymbolicFactor> symbolic,
                               const Execution& execution)
    : symbolic_(std::move(symbolic)), values_(factorise(*symbolic_, A, execution)) {
  inverse_diagonal_.resize(size());
  for (int32_t s = 0; s < symbolic_->supernodes(); ++s) {
    const int64_t width = symbolic_->width(s), rows = width + symbolic_->row_count(s);
    for (int64_t k = 0; k < width; ++k)
      inverse_diagonal_[symbolic_->first_column[s] + k] =
          1 / values_[symbolic_->value_start[s] + k * (rows + 1)];
  }
  values_f_.assign(values_.begin(), values_.end());
  inverse_diagonal_f_.assign(inverse_diagonal_.begin(), inverse_diagonal_.end());
}

void SparseCholesky::solve_block(double* X) const {
  solve_panels({symbolic_.get(), values_.data(), inverse_diagonal_.data()}, X);
}

void SparseCholesky::solve_block(float* X) const {
  solve_panels({symbolic_.get(), values_f_.data(), inverse_diagonal_f_.data()}, X);
}

Vector SparseCholesky::solve(const Vector& b) const {
  Vector x(size());
  for (int32_t i = 0; i < size(); ++i) x(permutation()[i]) = b(i);
  // Calls visit(column, value of the entry below the diagonal, its row) for supernode s.
  const auto for_each_below = [&](int32_t s, int64_t k, const auto& visit) {
    const int32_t first = symbolic_->first_column[s], width = symbolic_->width(s);
    const int64_t rows = width + symbolic_->row_count(s);
    const double* column = values_.data() + symbolic_->value_start[s] + k * rows;
    const int32_t* row = symbolic_->rows.data() + symbolic_->row_start[s];
    for (int64_t i = k + 1; i < width; ++i) visit(first + i, column[i]);
    for (int64_t i = width; i < rows; ++i) visit(row[i - width], column[i]);
  };
  for (int32_t s = 0; s < symbolic_->supernodes(); ++s)
    for (int32_t j = symbolic_->first_column[s]; j < symbolic_->first_column[s + 1]; ++j) {
      const double solved = x(j) *= inverse_diagonal_[j];
      for_each_below(s, j - symbolic_->first_column[s],
                     [&](int64_t i, double value) { x(i) -= value * solved; });
    }
  for (int32_t s = symbolic_->supernodes() - 1; s >= 0; --s)
    for (int32_t j = symbolic_->first_column[s + 1] - 1; j >= symbolic_->first_column[s]; --j) {
      double sum = 0;
      for_each_below(s, j - symbolic_->first_column[s],
                     [&](int64_t i, double value) { sum += value * x(i); });
      x(j) = (x(j) - sum) * inverse_diagonal_[j];
    }
  Vector out(size());
  for (int32_t i = 0; i < size(); ++i) out(i) = x(permutation()[i]);
  return out;
}

}  // namespace focal
