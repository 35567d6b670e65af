#include "operators/tufted_cover.h"

namespace focal {

std::optional<std::vector<int32_t>> manifold_gluing(const MatrixX3i& triangles, const EdgeSides& edges) {
  std::vector<int32_t> twin(edges.side.size(), -1);
  for (int32_t e = 0; e < edges.edge_count(); ++e) {
    const auto sides = edges.of_edge(e);
    if (sides.size() == 1) continue;
    if (sides.size() > 2 || side_from(triangles, sides[0]) != side_to(triangles, sides[1]))
      return std::nullopt;
    twin[sides[0]] = sides[1], twin[sides[1]] = sides[0];
  }
  return twin;
}

TuftedCover tufted_cover(const MatrixX3i& triangles, const EdgeSides& edges) {
  const auto m = static_cast<int32_t>(triangles.rows());
  TuftedCover cover;
  cover.triangles.resize(2 * m, 3);
  cover.triangles.topRows(m) = triangles;
  cover.triangles.bottomRows(m) << triangles.col(0), triangles.col(2), triangles.col(1);
  cover.twin.resize(6 * static_cast<size_t>(m));
  // The same edge on the given triangle or on its reversed copy, whichever goes from the smaller vertex to
  // the larger.
  const auto turned_over = [m](int32_t side) { return 3 * m + side - side % 3 + (3 - side % 3) % 3; };
  const auto upward = [&](int32_t side) {
    return side_from(triangles, side) < side_to(triangles, side) ? side : turned_over(side);
  };
  const auto downward = [&](int32_t side) {
    return side_from(triangles, side) < side_to(triangles, side) ? turned_over(side) : side;
  };
  for (int32_t e = 0; e < edges.edge_count(); ++e) {
    const auto sides = edges.of_edge(e);
    for (size_t i = 0; i < sides.size(); ++i) {
      const int32_t up = upward(sides[i]), down = downward(sides[(i + 1) % sides.size()]);
      cover.twin[up] = down, cover.twin[down] = up;
    }
  }
  return cover;
}

}  // namespace focal
