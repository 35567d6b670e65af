// How the sides of triangles are glued to each other: as the manifold that they form, or else as its tufted
// cover (N. Sharp, K. Crane, "A Laplacian for Nonmanifold Triangle Meshes", 2020), on which every edge has
// two triangles again.
#pragma once
#include <optional>
#include <vector>

#include "mesh/edges.h"

namespace focal {

// Per side (see mesh/edges.h) the side it is glued to, -1 at a border. Empty where an edge has more than two
// triangles, or two of opposite orientation, which cannot be unfolded.
std::optional<std::vector<int32_t>> manifold_gluing(const MatrixX3i& triangles, const EdgeSides& edges);

// Every triangle twice, t as given and m + t reversed (corners 1 and 2 swapped): the two sides of a sheet.
// Around an edge the upper side of one triangle is glued to the lower side of the next, so a border joins the
// two sides of its triangle.
struct TuftedCover {
  MatrixX3i triangles;        // 2 m x 3
  std::vector<int32_t> twin;  // 6 m, never -1
};
TuftedCover tufted_cover(const MatrixX3i& triangles, const EdgeSides& edges);

}  // namespace focal
