// A sparse Cholesky factor, computed once and used for many right-hand sides at a time.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "base/matrix.h"
#include "linear/symbolic_factor.h"

namespace focal {

// P A P^T = G G^T, A symmetric positive definite, ordered by approximate minimum degree. Each entry of the
// factor is read once for a block of `lanes` right-hand sides, which are interleaved: X[i * lanes + j] is row
// i of side j.
class SparseCholesky {
 public:
  static constexpr int lanes = 32;

  SparseCholesky() = default;
  // Only the lower triangle of A is read. Throws not_converged when A is not positive definite, and cancelled.
  explicit SparseCholesky(const SparseMatrix& A, const Execution& execution = {});
  // The same for an A whose entries are at the same positions as in `same_pattern`, or a subset: ordering and
  // analysis are shared.
  SparseCholesky(const SparseMatrix& A, const SparseCholesky& same_pattern, const Execution& execution = {});
  SparseCholesky(const SparseMatrix& A, std::shared_ptr<const SymbolicFactor> symbolic,
                 const Execution& execution = {});

  int32_t size() const { return symbolic_ ? symbolic_->size() : 0; }
  // Numbers stored: those of the factor, and a few zeros that make supernodes wider.
  int64_t stored() const { return static_cast<int64_t>(values_.size()); }
  std::shared_ptr<const SymbolicFactor> symbolic() const { return symbolic_; }
  // permutation()[old] = new: rows of the blocks below are in the new order.
  const std::vector<int32_t>& permutation() const { return symbolic_->permutation; }

  // Solves A X = B in place for `lanes` sides, rows in the permuted order; X holds size() * lanes numbers,
  // 64-byte aligned. Thread-safe. The float version rounds the factor to float.
  void solve_block(double* X) const;
  void solve_block(float* X) const;
  // One right-hand side, in the caller's order.
  Vector solve(const Vector& b) const;

 private:
  std::shared_ptr<const SymbolicFactor> symbolic_;
  std::vector<double> values_, inverse_diagonal_;  // the panels of G
  std::vector<float> values_f_, inverse_diagonal_f_;
};

}  // namespace focal
