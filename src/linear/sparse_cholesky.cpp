#include "linear/sparse_cholesky.h"

#include <algorithm>
#include <numeric>

#include "base/multiversion.h"
#include "linear/multifrontal.h"

namespace focal {
namespace {

constexpr int lanes = SparseCholesky::lanes;

// One triangular system: row i of the solution needs the rows of its entries, visited first, last, or in
// between.
template <class T>
struct Triangle {
  const int64_t* start;
  const int32_t* index;
  const T* value;
  const T* inverse_diagonal;
  int32_t n;
};

// The lanes [lane, lane + width) of one row. Two running sums hide the latency of the subtraction; which
// entry goes to which sum does not depend on the vector width, so every version gives the same bits.
template <int vector_bytes, int width, class T>
FOCAL_INLINE void solve_row(const Triangle<T>& triangle, int64_t i, int lane, T* X) {
  typedef T Lane __attribute__((vector_size(vector_bytes), may_alias));
  constexpr int vectors = width * int{sizeof(T)} / vector_bytes;
  const auto at = [&](int64_t row) { return reinterpret_cast<Lane*>(X + row * lanes + lane); };
  Lane even[vectors], odd[vectors];
  for (int v = 0; v < vectors; ++v) even[v] = at(i)[v], odd[v] = Lane{};
  int64_t p = triangle.start[i];
  const int64_t end = triangle.start[i + 1];
  for (; p + 1 < end; p += 2) {
    const Lane *x0 = at(triangle.index[p]), *x1 = at(triangle.index[p + 1]);
    const T g0 = triangle.value[p], g1 = triangle.value[p + 1];
    for (int v = 0; v < vectors; ++v) even[v] -= g0 * x0[v], odd[v] -= g1 * x1[v];
  }
  if (p < end) {
    const Lane* x = at(triangle.index[p]);
    for (int v = 0; v < vectors; ++v) even[v] -= triangle.value[p] * x[v];
  }
  for (int v = 0; v < vectors; ++v) at(i)[v] = (even[v] + odd[v]) * triangle.inverse_diagonal[i];
}

// G X = B by the rows of G from first to last, then G^T X = B by the columns of G from last to first.
template <int vector_bytes, class T>
FOCAL_INLINE void solve_both(const Triangle<T>& rows, const Triangle<T>& columns, T* X) {
  constexpr int width = std::min<int>(lanes, 4 * vector_bytes / sizeof(T));  // 2 x 4 sums stay in registers
  for (int64_t i = 0; i < rows.n; ++i)
    for (int lane = 0; lane < lanes; lane += width) solve_row<vector_bytes, width>(rows, i, lane, X);
  for (int64_t i = columns.n - 1; i >= 0; --i)
    for (int lane = 0; lane < lanes; lane += width) solve_row<vector_bytes, width>(columns, i, lane, X);
}

FOCAL_MULTIVERSION(void solve_lanes(const Triangle<double>& rows, const Triangle<double>& columns, double* X),
                   solve_both<vector_bytes>(rows, columns, X);)
FOCAL_MULTIVERSION(void solve_lanes(const Triangle<float>& rows, const Triangle<float>& columns, float* X),
                   solve_both<vector_bytes>(rows, columns, X);)

}  // namespace

SparseCholesky::SparseCholesky(const SparseMatrix& A)
    : SparseCholesky(A, std::make_shared<const SymbolicFactor>(analyse_pattern(A))) {}

SparseCholesky::SparseCholesky(const SparseMatrix& A, const SparseCholesky& same_pattern)
    : SparseCholesky(A, same_pattern.symbolic_) {}

SparseCholesky::SparseCholesky(const SparseMatrix& A, std::shared_ptr<const SymbolicFactor> symbolic)
    : symbolic_(std::move(symbolic)) {
  set_factor(factorise(*symbolic_, A));
}

// From panels to rows and columns, without the zeros that only make panels wider.
void SparseCholesky::set_factor(const std::vector<double>& panels) {
  const auto for_each = [&](const auto& visit) {  // entries (i, j), j from first to last
    for (int32_t s = 0; s < symbolic_->supernodes(); ++s) {
      const int32_t first = symbolic_->first_column[s], width = symbolic_->width(s);
      const int32_t* rows = symbolic_->rows.data() + symbolic_->row_start[s];
      const int64_t size = width + symbolic_->row_count(s);
      const double* column = panels.data() + symbolic_->value_start[s];
      for (int32_t k = 0; k < width; ++k, column += size)
        for (int64_t i = k; i < size; ++i)
          if (column[i] != 0)
            visit(i < width ? first + static_cast<int32_t>(i) : rows[i - width], first + k, column[i]);
    }
  };
  const int32_t n = size();
  inverse_diagonal_.resize(n);
  rows_.start.assign(n + 1, 0), columns_.start.assign(n + 1, 0);
  for_each(
      [&](int32_t i, int32_t j, double) { rows_.start[i + 1] += i != j, columns_.start[j + 1] += i != j; });
  std::partial_sum(rows_.start.begin(), rows_.start.end(), rows_.start.begin());
  std::partial_sum(columns_.start.begin(), columns_.start.end(), columns_.start.begin());
  for (Rows* side : {&rows_, &columns_})
    side->index.resize(side->start[n]), side->value.resize(side->start[n]);
  std::vector<int64_t> next(rows_.start.begin(), rows_.start.end() - 1);
  int64_t p = 0;
  for_each([&](int32_t i, int32_t j, double value) {
    if (i == j) {
      inverse_diagonal_[j] = 1 / value;
      return;
    }
    const int64_t q = next[i]++;
    rows_.index[q] = j, rows_.value[q] = value;
    columns_.index[p] = i, columns_.value[p++] = value;
  });
  rows_.value_f.assign(rows_.value.begin(), rows_.value.end());
  columns_.value_f.assign(columns_.value.begin(), columns_.value.end());
  inverse_diagonal_f_.assign(inverse_diagonal_.begin(), inverse_diagonal_.end());
}

void SparseCholesky::solve_block(double* X) const {
  const double* d = inverse_diagonal_.data();
  solve_lanes({rows_.start.data(), rows_.index.data(), rows_.value.data(), d, size()},
              {columns_.start.data(), columns_.index.data(), columns_.value.data(), d, size()}, X);
}

void SparseCholesky::solve_block(float* X) const {
  const float* d = inverse_diagonal_f_.data();
  solve_lanes({rows_.start.data(), rows_.index.data(), rows_.value_f.data(), d, size()},
              {columns_.start.data(), columns_.index.data(), columns_.value_f.data(), d, size()}, X);
}

// Here each solved row is scattered to the rows that need it: gathering a single side would chain its
// subtractions.
Vector SparseCholesky::solve(const Vector& b) const {
  Vector x(size());
  for (int32_t i = 0; i < size(); ++i) x(permutation()[i]) = b(i);
  const auto finish_row = [&](const Rows& needed_by, int32_t i) {
    const double solved = x(i) *= inverse_diagonal_[i];
    for (int64_t p = needed_by.start[i]; p < needed_by.start[i + 1]; ++p)
      x(needed_by.index[p]) -= needed_by.value[p] * solved;
  };
  for (int32_t i = 0; i < size(); ++i) finish_row(columns_, i);
  for (int32_t i = size() - 1; i >= 0; --i) finish_row(rows_, i);
  Vector out(size());
  for (int32_t i = 0; i < size(); ++i) out(i) = x(permutation()[i]);
  return out;
}

}  // namespace focal
