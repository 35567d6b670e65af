#include "mesh/nearest_vertex.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace focal {

NearestVertex::NearestVertex(const MatrixX3& positions, std::vector<int32_t> subset)
    : positions_(&positions), order_(std::move(subset)) {
  build(0, static_cast<int32_t>(order_.size()), 0);
}

NearestVertex::NearestVertex(const MatrixX3& positions)
    : positions_(&positions), order_(static_cast<size_t>(positions.rows())) {
  std::iota(order_.begin(), order_.end(), 0);
  build(0, static_cast<int32_t>(order_.size()), 0);
}

void NearestVertex::build(int32_t begin, int32_t end, int axis) {
  if (end - begin < 2) return;
  const int32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](int32_t a, int32_t b) {
                     const double x = (*positions_)(a, axis), y = (*positions_)(b, axis);
                     return x != y ? x < y : a < b;
                   });
  build(begin, middle, (axis + 1) % 3);
  build(middle + 1, end, (axis + 1) % 3);
}

void NearestVertex::search(int32_t begin, int32_t end, int axis, const Vector3& query,
                           std::pair<int32_t, double>& best) const {
  if (begin >= end) return;
  const int32_t middle = begin + (end - begin) / 2, id = order_[middle];
  const double squared = (positions_->row(id).transpose() - query).squaredNorm();
  if (squared < best.second || (squared == best.second && id < best.first)) best = {id, squared};
  const double across = query[axis] - (*positions_)(id, axis);
  const int next = (axis + 1) % 3;
  if (across < 0) {
    search(begin, middle, next, query, best);
    if (across * across <= best.second) search(middle + 1, end, next, query, best);
  } else {
    search(middle + 1, end, next, query, best);
    if (across * across <= best.second) search(begin, middle, next, query, best);
  }
}

std::pair<int32_t, double> NearestVertex::nearest(const Vector3& query) const {
  return nearest(query, {-1, std::numeric_limits<double>::infinity()});
}

std::pair<int32_t, double> NearestVertex::nearest(const Vector3& query,
                                                  std::pair<int32_t, double> best) const {
  search(0, static_cast<int32_t>(order_.size()), 0, query, best);
  return best;
}

void NearestOfGrowingSet::add(std::vector<int32_t> numbers) {
  while (!trees_.empty() && trees_.back().subset().size() <= numbers.size()) {
    const std::vector<int32_t>& last = trees_.back().subset();
    numbers.insert(numbers.end(), last.begin(), last.end());
    trees_.pop_back();
  }
  trees_.emplace_back(*positions_, std::move(numbers));
}

std::pair<int32_t, double> NearestOfGrowingSet::nearest(const Vector3& query) const {
  std::pair<int32_t, double> best{-1, std::numeric_limits<double>::infinity()};
  for (const NearestVertex& tree : trees_) best = tree.nearest(query, best);
  return best;
}

}  // namespace focal
