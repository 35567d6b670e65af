// One hole's patch: triangles over its loop, refined to the density around it and made smooth with it.
#pragma once
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "base/matrix.h"

namespace focal {

// What the patch needs to know of the surface. Loop vertices are numbered 0 .. n-1.
struct HoleLoop {
  std::vector<Vector3> positions;
  std::vector<Vector3> outer_normal;  // unit, of the surface's triangle at the edge from vertex i to i + 1
  std::vector<Vector3> outer_sum;     // of the positions of the surface's neighbours of vertex i
  std::vector<int32_t> outer_count;   // how many those are
  std::vector<double> density;        // mean length of the surface's edges at vertex i
  std::set<std::pair<int32_t, int32_t>>
      taken;  // other pairs of loop vertices with an edge between them, smaller first
};

struct HolePatch {
  std::vector<Vector3> inner;                     // new vertices, numbered from n on
  std::vector<std::array<int32_t, 3>> triangles;  // empty: the loop cannot be closed
};

HolePatch patch_hole(const HoleLoop& loop);

}  // namespace focal
