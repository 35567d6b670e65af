// Elimination tree and supernodes (J. Liu, "The role of elimination trees in sparse factorization", 1990;
// J. Liu, E. Ng, B. Peyton, "On finding supernodes for sparse matrix computations", 1993), after an approximate
// minimum degree ordering (P. Amestoy, T. Davis, I. Duff, 1996; Eigen's).
#include "linear/symbolic_factor.h"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <numeric>

namespace focal {
namespace {

// Columns of the strict lower triangle in a new order, as a list of rows each.
struct Pattern {
  std::vector<int32_t> start, row;
};

Pattern permuted_pattern(const SparseMatrix& A, const std::vector<int32_t>& order) {
  const auto n = static_cast<int32_t>(A.cols());
  Pattern pattern{std::vector<int32_t>(n + 1, 0), {}};
  const auto for_each = [&](const auto& visit) {
    for (int32_t j = 0; j < n; ++j)
      for (SparseMatrix::InnerIterator entry(A, j); entry; ++entry)
        if (entry.row() > j) {
          const auto [column, row] = std::minmax(order[j], order[entry.row()]);
          visit(column, row);
        }
  };
  for_each([&](int32_t column, int32_t) { ++pattern.start[column + 1]; });
  std::partial_sum(pattern.start.begin(), pattern.start.end(), pattern.start.begin());
  pattern.row.resize(pattern.start[n]);
  std::vector<int32_t> next(pattern.start.begin(), pattern.start.end() - 1);
  for_each([&](int32_t column, int32_t row) { pattern.row[next[column]++] = row; });
  return pattern;
}

std::vector<int32_t> minimum_degree(const SparseMatrix& A) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int32_t> inverse;
  SparseMatrix::Base full;  // filled after construction, see base/matrix.h
  full = A.selfadjointView<Eigen::Lower>();
  Eigen::AMDOrdering<int32_t>()(full, inverse);
  std::vector<int32_t> order(A.cols());
  for (int32_t i = 0; i < inverse.size(); ++i) order[inverse.indices()[i]] = i;
  return order;
}

// Parent of each column: the first row below its diagonal in the factor; n at a root.
std::vector<int32_t> elimination_tree(const SparseMatrix& A, const std::vector<int32_t>& order) {
  const auto n = static_cast<int32_t>(A.cols());
  const Pattern pattern = permuted_pattern(A, order);
  // Liu's algorithm goes by rows: the columns left of the diagonal in each.
  Pattern rows{std::vector<int32_t>(n + 1, 0), std::vector<int32_t>(pattern.row.size())};
  for (const int32_t i : pattern.row) ++rows.start[i + 1];
  std::partial_sum(rows.start.begin(), rows.start.end(), rows.start.begin());
  std::vector<int32_t> next(rows.start.begin(), rows.start.end() - 1);
  for (int32_t j = 0; j < n; ++j)
    for (int32_t p = pattern.start[j]; p < pattern.start[j + 1]; ++p) rows.row[next[pattern.row[p]]++] = j;
  std::vector<int32_t> parent(n, n), shortcut(n, n);
  for (int32_t i = 0; i < n; ++i)
    for (int32_t p = rows.start[i]; p < rows.start[i + 1]; ++p)
      for (int32_t j = rows.row[p]; j < i;) {
        const int32_t up = shortcut[j];
        shortcut[j] = i;
        if (up == n) parent[j] = i;
        j = up;
      }
  return parent;
}

// [column] = its position when every subtree is numbered without gaps.
std::vector<int32_t> postorder(const std::vector<int32_t>& parent) {
  const auto n = static_cast<int32_t>(parent.size());
  std::vector<int32_t> size(n + 1, 1), place(n + 1), used(n + 1, 0);
  for (int32_t j = 0; j < n; ++j) size[parent[j]] += size[j];
  // Parents come after their children, so from the last column on: each subtree takes the next free range.
  place[n] = n, used[n] = 0;
  for (int32_t j = n - 1; j >= 0; --j) {
    const int32_t p = parent[j];
    place[j] = place[p] - 1 - used[p];
    used[p] += size[j];
  }
  place.pop_back();
  return place;
}

// Supernodes under construction, in the order of their columns.
class Supernodes {
 public:
  struct Node {
    int32_t first, width;
    std::vector<int32_t> rows;
    int64_t zeros = 0;  // stored entries that are not in the factor
  };

  Supernodes(const Pattern& pattern, const Execution& execution)
      : pattern_(pattern), n_(static_cast<int32_t>(pattern.start.size()) - 1), mark_(n_, -1), waiting_(n_) {
    for (int32_t j = 0; j < n_; ++j) {
      if (j % 4096 == 0) execution.check_cancelled();
      add_column(j);
    }
    merge();
  }
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  // The rows of a column are those of the matrix and of the supernodes whose first row it is. If these are no
  // more than those of the preceding supernode, the column joins it.
  void add_column(int32_t j) {
    std::vector<int32_t> rows;
    const auto take = [&](int32_t i) {
      if (i > j && mark_[i] != j) mark_[i] = j, rows.push_back(i);
    };
    for (int32_t p = pattern_.start[j]; p < pattern_.start[j + 1]; ++p) take(pattern_.row[p]);
    for (const int32_t s : waiting_[j])
      for (const int32_t i : nodes_[s].rows) take(i);
    if (!nodes_.empty() && !nodes_.back().rows.empty() && nodes_.back().rows[0] == j &&
        rows.size() + 1 == nodes_.back().rows.size()) {
      nodes_.back().rows.erase(nodes_.back().rows.begin());
      ++nodes_.back().width;
    } else {
      std::sort(rows.begin(), rows.end());
      nodes_.push_back({j, 1, std::move(rows)});
    }
    if (!nodes_.back().rows.empty())
      waiting_[nodes_.back().rows[0]].push_back(static_cast<int32_t>(nodes_.size()) - 1);
    waiting_[j] = {};
  }

  // Wider panels are worth a few zeros: a child is merged into its parent while few are added.
  void merge() {
    std::vector<Node> merged;
    for (Node& node : nodes_) {
      while (!merged.empty() && worth_merging(merged.back(), node)) {
        node.zeros += merged.back().zeros + added_zeros(merged.back(), node);
        node.first = merged.back().first, node.width += merged.back().width;
        merged.pop_back();
      }
      merged.push_back(std::move(node));
    }
    nodes_ = std::move(merged);
  }
  static int64_t added_zeros(const Node& child, const Node& parent) {
    return int64_t{child.width} * (parent.width + std::ssize(parent.rows) - std::ssize(child.rows));
  }
  static bool worth_merging(const Node& child, const Node& parent) {
    if (child.rows.empty() || child.rows[0] >= parent.first + parent.width) return false;
    const int64_t width = child.width + parent.width;
    const int64_t size = width * (width + 1) / 2 + width * std::ssize(parent.rows);
    const int64_t zeros = child.zeros + parent.zeros + added_zeros(child, parent);
    return zeros <= size * (width <= 4 ? 0.15 : width <= 16 ? 0.08 : 0.04);
  }

  const Pattern& pattern_;
  int32_t n_;
  std::vector<int32_t> mark_;
  std::vector<std::vector<int32_t>> waiting_;
  std::vector<Node> nodes_;
};

}  // namespace

SymbolicFactor analyse_pattern(const SparseMatrix& A, std::vector<int32_t> order,
                               const Execution& execution) {
  if (order.empty()) order = minimum_degree(A);
  execution.check_cancelled();
  const std::vector<int32_t> place = postorder(elimination_tree(A, order));
  for (int32_t& i : order) i = place[i];
  const Pattern pattern = permuted_pattern(A, order);
  SymbolicFactor factor;
  factor.permutation = std::move(order);
  factor.first_column = {0}, factor.row_start = {0}, factor.value_start = {0};
  const Supernodes supernodes(pattern, execution);
  for (const auto& node : supernodes.nodes()) {
    factor.first_column.push_back(node.first + node.width);
    factor.rows.insert(factor.rows.end(), node.rows.begin(), node.rows.end());
    factor.row_start.push_back(static_cast<int64_t>(factor.rows.size()));
    factor.value_start.push_back(factor.value_start.back() +
                                 int64_t{node.width} * (node.width + std::ssize(node.rows)));
  }
  return factor;
}

}  // namespace focal
