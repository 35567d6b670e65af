#include "linear/nested_dissection.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace focal {
namespace {

constexpr size_t smallest_part = 64;  // vertices that are no longer cut; measured flat from 32 to 128

class Dissection {
 public:
  Dissection(const SparseMatrix& A, const MatrixX3& positions)
      : A_(A),
        positions_(positions),
        side_(positions.rows(), 0),
        vertices_(positions.rows()),
        order_(positions.rows()) {
    std::iota(vertices_.begin(), vertices_.end(), 0);
  }

  std::vector<int32_t> run() {
    number(vertices_, static_cast<int32_t>(vertices_.size()));
    return std::move(order_);
  }

 private:
  // Gives a part the numbers below `end`, separators the highest of each part.
  void number(std::span<int32_t> part, int32_t end) {
    if (part.size() <= smallest_part) {
      for (const int32_t v : part) order_[v] = --end;
      return;
    }
    const size_t half = part.size() / 2;
    split_at_median(part, half);
    // Those of the second half that touch the first stand between them.
    for (size_t i = 0; i < part.size(); ++i) side_[part[i]] = i < half ? next_mark_ : next_mark_ + 1;
    const int32_t first_mark = next_mark_;
    next_mark_ += 2;
    const auto between = std::stable_partition(part.begin() + half, part.end(),
                                               [&](int32_t v) { return !touches(v, first_mark); });
    for (auto v = between; v != part.end(); ++v) order_[*v] = --end;
    const auto second = static_cast<size_t>(between - part.begin()) - half;
    number(part.subspan(half, second), end);
    number(part.first(half), end - static_cast<int32_t>(second));
  }

  // Across the longest side of the part's box.
  void split_at_median(std::span<int32_t> part, size_t half) const {
    Eigen::RowVector3d low = positions_.row(part[0]), high = low;
    for (const int32_t v : part)
      low = low.cwiseMin(positions_.row(v)), high = high.cwiseMax(positions_.row(v));
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    std::nth_element(part.begin(), part.begin() + half, part.end(), [&](int32_t a, int32_t b) {
      return positions_(a, axis) != positions_(b, axis) ? positions_(a, axis) < positions_(b, axis) : a < b;
    });
    std::sort(part.begin(),
              part.begin() + half);  // nth_element leaves an order that the standard does not fix
    std::sort(part.begin() + half, part.end());
  }

  bool touches(int32_t v, int32_t mark) const {
    for (SparseMatrix::InnerIterator entry(A_, v); entry; ++entry)
      if (side_[entry.row()] == mark) return true;
    return false;
  }

  const SparseMatrix& A_;
  const MatrixX3& positions_;
  std::vector<int32_t> side_, vertices_, order_;
  int32_t next_mark_ = 1;
};

}  // namespace

std::vector<int32_t> nested_dissection(const SparseMatrix& A, const MatrixX3& positions) {
  return Dissection(A, positions).run();
}

}  // namespace focal
