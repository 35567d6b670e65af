// Nearest of a fixed set of points: a kd-tree (Bentley 1975) over their numbers.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/matrix.h"

namespace focal {

class NearestVertex {
 public:
  // Keeps a pointer to positions: they must outlive it. Only the numbers in `subset` are searched.
  NearestVertex(const MatrixX3& positions, std::vector<int32_t> subset);
  explicit NearestVertex(const MatrixX3& positions);  // all of them
  // The number of the nearest point and its squared distance. The set must not be empty.
  std::pair<int32_t, double> nearest(const Vector3& query) const;
  // The same where a nearer one than `best` is there, else `best`; of equally near ones the smaller number.
  std::pair<int32_t, double> nearest(const Vector3& query, std::pair<int32_t, double> best) const;
  const std::vector<int32_t>& subset() const { return order_; }

 private:
  void search(int32_t begin, int32_t end, int axis, const Vector3& query,
              std::pair<int32_t, double>& best) const;
  void build(int32_t begin, int32_t end, int axis);
  const MatrixX3* positions_;
  std::vector<int32_t> order_;
};

// The same for a set that grows: trees of falling sizes, where small ones merge (Bentley and Saxe 1980).
class NearestOfGrowingSet {
 public:
  // Keeps a pointer to positions: they must outlive it.
  explicit NearestOfGrowingSet(const MatrixX3& positions) : positions_(&positions) {}
  void add(std::vector<int32_t> numbers);
  std::pair<int32_t, double> nearest(const Vector3& query) const;

 private:
  const MatrixX3* positions_;
  std::vector<NearestVertex> trees_;
};

}  // namespace focal
