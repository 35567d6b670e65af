// A triangle mesh for straight-line paths: half-edges with their twins and lengths, and the vertices at which
// paths bend.
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace focal {

// Half-edge 3 t + i goes from corner i of triangle t to its corner i + 1; the triangle is on its left.
struct HalfEdges {
  static int32_t next(int32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static int32_t previous(int32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

  std::vector<int32_t> origin, twin;  // twin -1: a border, or an edge of more than two triangles
  std::vector<double> length;
  // The corner opposite to a half-edge, in the frame in which the half-edge goes from (0, 0) to (length, 0).
  std::vector<double> apex_x, apex_y;
  // Shortest paths bend only at vertices with a total angle of more than 360 degrees and at borders.
  std::vector<char> bends;
  // Half-edges that start at vertex v: outgoing[first[v] .. first[v + 1]).
  std::vector<int32_t> first, outgoing;

  int32_t target(int32_t h) const { return origin[next(h)]; }
  std::span<const int32_t> from(int32_t v) const {
    return std::span(outgoing).subspan(first[v], first[v + 1] - first[v]);
  }
};

// bridges: pairs of vertices with a straight connection; paths may bend there.
HalfEdges half_edges_of(const TriangleMesh& mesh, std::span<const std::pair<int32_t, int32_t>> bridges);

}  // namespace focal
