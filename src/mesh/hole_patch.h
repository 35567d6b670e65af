// The patch of one hole: triangles over its loop, refined to the density around it and faired to continue the
// surface.
#pragma once
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "base/matrix.h"

namespace focal {

// The data of the surface that the patch needs. Loop vertices are numbered 0 .. n-1.
struct HoleLoop {
  std::vector<Vector3> positions;
  std::vector<Vector3> outer_normal;  // unit, of the surface's triangle at the edge from vertex i to i + 1
  std::vector<Vector3> outer_sum;     // of the positions of the surface's neighbours of vertex i
  std::vector<int32_t> outer_count;   // number of these neighbours
  std::vector<double> density;        // mean length of the surface's edges at vertex i
  // Other pairs of loop vertices with an edge between them, smaller first.
  std::set<std::pair<int32_t, int32_t>> taken;
};

struct HolePatch {
  std::vector<Vector3> inner;                     // new vertices, numbered from n on
  std::vector<std::array<int32_t, 3>> triangles;  // empty: the loop cannot be closed
};

HolePatch patch_hole(const HoleLoop& loop);

}  // namespace focal
