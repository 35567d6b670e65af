// Connectivity of a mesh, and the triangles to flip for a consistent orientation.
#pragma once
#include <vector>

#include "mesh/edges.h"

namespace focal {

struct Topology {
  int64_t nonmanifold_edges = 0;     // of more than two triangles
  int64_t nonmanifold_vertices = 0;  // parts of the surface meet only in this point
  int64_t boundary_loops = 0;        // connected curves of edges of one triangle: holes, open ends
};
Topology topology_of(const TriangleMesh& mesh, const EdgeSides& edges);

struct Orientation {
  std::vector<char> flipped;  // per triangle: to be flipped
  int64_t flips = 0;
  // False where more than a hundredth of the area is in patches without a consistent orientation (a Moebius
  // strip). Their triangles are not flipped.
  bool is_consistent = true;
};

// A patch is connected by edges of exactly two triangles. All triangles of a patch get a consistent
// orientation: a closed patch encloses a positive volume, an open one keeps the orientation of most of its
// triangles.
Orientation consistent_orientation(const TriangleMesh& mesh, const EdgeSides& edges);

}  // namespace focal
