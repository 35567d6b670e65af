// The structure of a sparse Cholesky factor, before its numbers are computed: ordering, supernodes and their
// rows.
#pragma once
#include <cstdint>
#include <vector>

#include "base/matrix.h"
#include "base/parallel.h"

namespace focal {

// Supernode s consists of the columns [first_column[s], first_column[s + 1]) of the factor, in the new order.
// Below their triangle they share the rows rows[row_start[s]] .. rows[row_start[s + 1] - 1], ascending. Its
// panel, triangle and rows, is stored column by column from value_start[s] on.
struct SymbolicFactor {
  std::vector<int32_t> permutation;  // [old] = new
  std::vector<int32_t> first_column, rows;
  std::vector<int64_t> row_start, value_start;

  int32_t size() const { return static_cast<int32_t>(permutation.size()); }
  int32_t supernodes() const { return static_cast<int32_t>(first_column.size()) - 1; }
  int32_t width(int32_t s) const { return first_column[s + 1] - first_column[s]; }
  int32_t row_count(int32_t s) const { return static_cast<int32_t>(row_start[s + 1] - row_start[s]); }
};

// order: [old] = new, or empty for approximate minimum degree. Only the lower triangle of A is read. The
// resulting order may differ from the given one, but has the same fill-in.
SymbolicFactor analyse_pattern(const SparseMatrix& A, std::vector<int32_t> order = {},
                               const Execution& execution = {});

}  // namespace focal
