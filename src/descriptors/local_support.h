// The part of a surface around a point that extrinsic descriptors use: small enough that a bent limb hardly
// changes it.
#pragma once
#include <vector>

#include "descriptors/descriptor.h"

namespace focal {

inline constexpr double support_radius = 0.2;  // in sqrt(area)

struct Neighbour {
  Vector3 offset;  // from the described point
  double share;    // of the area of all neighbours
};

// Vertices within `radius` in space that are connected with the point inside that ball.
std::vector<Neighbour> local_support(const DescribedSurface& surface, int32_t vertex, double radius);

}  // namespace focal
