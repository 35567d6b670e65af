// The part of a surface round a point that extrinsic descriptors look at: small enough that a bent limb hardly changes it.
#pragma once
#include <vector>

#include "descriptors/descriptor.h"

namespace focal {

inline constexpr double support_radius = 0.2;  // of sqrt(area)

struct Neighbour {
  Vector3 offset;  // from the point described
  double share;    // of the area of all neighbours
};

// Vertices within `radius` in space and connected with the point within it.
std::vector<Neighbour> local_support(const DescribedSurface& surface, int32_t vertex, double radius);

}  // namespace focal
