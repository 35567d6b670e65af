// The undirected edges of a mesh with all triangles at each edge, whatever their number.
#pragma once
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace focal {

// Side 3 t + i is the edge of triangle t opposite to its corner i; it goes from corner i + 1 to corner i + 2.
inline int32_t side_from(const MatrixX3i& triangles, int32_t side) {
  return triangles(side / 3, (side + 1) % 3);
}
inline int32_t side_to(const MatrixX3i& triangles, int32_t side) {
  return triangles(side / 3, (side + 2) % 3);
}

// Edges sorted by their smaller, then their larger end; the sides of an edge by their number.
struct EdgeSides {
  std::vector<int32_t> side, start{0};  // edge e: side[start[e]] .. side[start[e + 1]]

  int32_t edge_count() const { return static_cast<int32_t>(start.size()) - 1; }
  std::span<const int32_t> of_edge(int32_t e) const {
    return std::span(side).subspan(start[e], start[e + 1] - start[e]);
  }
};

// Linear in the number of triangles: by counting, then by sorting the few sides at each vertex.
EdgeSides edge_sides(const TriangleMesh& mesh);

}  // namespace focal
