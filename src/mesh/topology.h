// How the triangles of a mesh hang together, and which of them must be turned over for neighbours to face the same way.
#pragma once
#include <vector>

#include "mesh/edges.h"

namespace focal {

struct Topology {
  int64_t nonmanifold_edges = 0;     // of more than two triangles
  int64_t nonmanifold_vertices = 0;  // where parts of the surface meet in nothing but a point
  int64_t boundary_loops = 0;        // connected curves of edges of one triangle: holes, open ends
};
Topology topology_of(const TriangleMesh& mesh, const EdgeSides& edges);

struct Orientation {
  std::vector<char> flipped;  // per triangle: to be turned over
  int64_t flips = 0;
  // False where more than a hundredth of the area lies in patches that no turning makes consistent (a Moebius strip).
  // Their triangles stay as they are.
  bool is_consistent = true;
};

// A patch is what edges of exactly two triangles connect. In each, all triangles are made to agree; a closed patch is
// turned to enclose a positive volume, an open one to where most of its triangles faced.
Orientation consistent_orientation(const TriangleMesh& mesh, const EdgeSides& edges);

}  // namespace focal
