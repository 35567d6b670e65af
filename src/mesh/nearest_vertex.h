// Nearest-point queries in a fixed set of points: a kd-tree (Bentley 1975) over their numbers.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/matrix.h"

namespace focal {

class NearestVertex {
 public:
  // Keeps a pointer to positions, which must outlive this object. Searches only the numbers in `subset`.
  NearestVertex(const MatrixX3& positions, std::vector<int32_t> subset);
  explicit NearestVertex(const MatrixX3& positions);  // all positions
  // The number of the nearest point and its squared distance. The set must not be empty.
  std::pair<int32_t, double> nearest(const Vector3& query) const;
  // The same, but starting with `best`; among equally near points the smaller number.
  std::pair<int32_t, double> nearest(const Vector3& query, std::pair<int32_t, double> best) const;
  const std::vector<int32_t>& subset() const { return order_; }

 private:
  void search(int32_t begin, int32_t end, int axis, const Vector3& query,
              std::pair<int32_t, double>& best) const;
  void build(int32_t begin, int32_t end, int axis);
  const MatrixX3* positions_;
  std::vector<int32_t> order_;
};

// The same for a growing set: trees of decreasing sizes, in which small ones are merged (Bentley and Saxe
// 1980).
class NearestOfGrowingSet {
 public:
  // Keeps a pointer to positions, which must outlive this object.
  explicit NearestOfGrowingSet(const MatrixX3& positions) : positions_(&positions) {}
  void add(std::vector<int32_t> numbers);
  std::pair<int32_t, double> nearest(const Vector3& query) const;

 private:
  const MatrixX3* positions_;
  std::vector<NearestVertex> trees_;
};

}  // namespace focal
