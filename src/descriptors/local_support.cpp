#include "descriptors/local_support.h"

namespace focal {

std::vector<Neighbour> local_support(const DescribedSurface& surface, int32_t vertex, double radius) {
  const MatrixX3& positions = surface.mesh.positions;
  std::vector<Neighbour> neighbours;
  double total = 0;
  for (const int32_t v : connected_ball(surface.operators.L, positions, vertex, radius)) {
    neighbours.push_back({positions.row(v) - positions.row(vertex), surface.operators.mass[v]});
    total += surface.operators.mass[v];
  }
  for (Neighbour& neighbour : neighbours) neighbour.share /= total;
  return neighbours;
}

}  // namespace focal
