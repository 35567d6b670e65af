// Axis-aligned boxes.
#pragma once
#include <limits>

#include "base/matrix.h"

namespace focal {

struct Box {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = Vector3::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vector3& point) { low = low.cwiseMin(point), high = high.cwiseMax(point); }
  void add(const Box& other) { low = low.cwiseMin(other.low), high = high.cwiseMax(other.high); }
  double diagonal() const { return (high - low).norm(); }  // infinite for an empty box
};

// Distance between the nearest points of two boxes.
inline double gap(const Box& a, const Box& b) {
  return (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0).norm();
}

}  // namespace focal
