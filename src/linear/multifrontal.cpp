// The multifrontal method (J. Liu, "The multifrontal method for sparse matrix solution: theory and practice",
// 1992): every supernode assembles its columns of the matrix and its children's update matrices in one small
// dense matrix, eliminates its own columns and passes the rest to its parent.
#include "linear/multifrontal.h"

#include <algorithm>
#include <memory>
#include <numeric>

#include "base/aligned_array.h"
#include "base/error.h"
#include "linear/front_kernel.h"

namespace focal {
namespace {

// The lower triangle in the order of the factor, by columns, rows in any order.
struct PermutedColumns {
  std::vector<int32_t> start, row;
  std::vector<double> value;

  PermutedColumns(const SparseMatrix& A, const std::vector<int32_t>& order) : start(A.cols() + 1, 0) {
    const auto for_each = [&](const auto& visit) {
      for (int32_t j = 0; j < A.cols(); ++j)
        for (SparseMatrix::InnerIterator entry(A, j); entry; ++entry)
          if (entry.row() >= j) visit(std::minmax(order[j], order[entry.row()]), entry.value());
    };
    for_each([&](auto place, double) { ++start[place.first + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    row.resize(start.back()), value.resize(start.back());
    std::vector<int32_t> next(start.begin(), start.end() - 1);
    for_each([&](auto place, double x) {
      const int32_t p = next[place.first]++;
      row[p] = place.second, value[p] = x;
    });
  }
};

// The dense upper triangle of a supernode: its own rows first, then those below.
struct Front {
  int64_t size, stride;
  AlignedArray<double> data;

  explicit Front(int64_t size_) : size(size_), stride((size_ + 7) / 8 * 8), data(size * stride) {
    std::fill_n(data.data(), data.size(), 0.0);
  }
  double* row(int64_t i) const { return data.data() + i * stride; }
};

class Multifrontal {
 public:
  Multifrontal(const SymbolicFactor& symbolic, const SparseMatrix& A)
      : symbolic_(symbolic), A_(A, symbolic.permutation), local_(symbolic.size()) {
    std::vector<int32_t> supernode_of(symbolic.size());
    left_over_.resize(symbolic.supernodes()), children_.resize(symbolic.supernodes());
    for (int32_t s = 0; s < symbolic.supernodes(); ++s)
      std::fill(supernode_of.begin() + symbolic.first_column[s],
                supernode_of.begin() + symbolic.first_column[s + 1], s);
    for (int32_t s = 0; s < symbolic.supernodes(); ++s)
      if (symbolic.row_count(s) > 0) children_[supernode_of[rows(s)[0]]].push_back(s);
  }

  void run(double* values, const Execution& execution) {
    for (int32_t s = 0; s < symbolic_.supernodes(); ++s) {
      execution.check_cancelled();
      const int64_t width = symbolic_.width(s), size = width + symbolic_.row_count(s);
      Front front(size);
      gather(s, front);
      if (!eliminate(front.data.data(), size, front.stride, width))
        throw Error(Status::not_converged,
                    "a matrix of the mesh is not positive definite, so it cannot be factored",
                    "the mesh may hold degenerate or non-finite triangles; repair it first");
      double* panel = values + symbolic_.value_start[s];
      for (int64_t k = 0; k < width; ++k)
        std::copy(front.row(k) + k, front.row(k) + size, panel + k * size + k);
      left_over_[s] = std::make_unique<Front>(std::move(front));
    }
  }

 private:
  const int32_t* rows(int32_t s) const { return symbolic_.rows.data() + symbolic_.row_start[s]; }

  void gather(int32_t s, const Front& front) {
    const int32_t first = symbolic_.first_column[s], width = symbolic_.width(s);
    for (int32_t k = 0; k < width; ++k) local_[first + k] = k;
    for (int32_t i = 0; i < symbolic_.row_count(s); ++i) local_[rows(s)[i]] = width + i;
    for (int32_t k = 0; k < width; ++k)
      for (int32_t p = A_.start[first + k]; p < A_.start[first + k + 1]; ++p)
        front.row(k)[checked_local(s, A_.row[p])] += A_.value[p];
    for (const int32_t child : children_[s]) {
      const int64_t skip = symbolic_.width(child), count = symbolic_.row_count(child);
      const int32_t* row = rows(child);
      for (int64_t i = 0; i < count; ++i) {
        double* to = front.row(local_[row[i]]);
        const double* from = left_over_[child]->row(skip + i) + skip;
        for (int64_t j = i; j < count; ++j) to[local_[row[j]]] += from[j];
      }
      left_over_[child].reset();
    }
  }

  int32_t checked_local(int32_t s, int32_t i) const {
    const int32_t at = local_[i], width = symbolic_.width(s), first = symbolic_.first_column[s];
    const bool own = i < first + width;
    if (!own && (at < width || at >= width + symbolic_.row_count(s) || rows(s)[at - width] != i))
      throw Error(Status::internal, "a matrix does not have the pattern it was analysed for", "report this");
    return own ? i - first : at;
  }

  const SymbolicFactor& symbolic_;
  PermutedColumns A_;
  std::vector<int32_t> local_;  // row of the matrix: its row in the current front
  std::vector<std::unique_ptr<Front>> left_over_;
  std::vector<std::vector<int32_t>> children_;
};

}  // namespace

std::vector<double> factorise(const SymbolicFactor& symbolic, const SparseMatrix& A,
                              const Execution& execution) {
  if (A.cols() != symbolic.size())
    throw Error(Status::internal, "a matrix does not have the size it was analysed for", "report this");
  std::vector<double> values(symbolic.value_start.back(), 0.0);
  Multifrontal(symbolic, A).run(values.data(), execution);
  execution.check_cancelled();
  return values;
}

}  // namespace focal
