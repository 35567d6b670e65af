// Closes holes, so that the analysis sees the surface that a scanner missed: holes change heat, spectra and
// geodesics considerably. Only borders that are simple loops; a hole that cannot be closed cleanly stays
// open.
#pragma once
#include <vector>

#include "mesh/triangle_mesh.h"

namespace focal {

struct FillParams {
  // Longest border that is closed, relative to sqrt(area of the mesh). Measured on corrupted training shapes:
  // see docs/accuracy.md.
  double longest_border = 1.5;
  // A patch larger than this share of the area of its component is not a hole but the rim of an open sheet.
  double largest_share = 0.1;
};

struct FilledMesh {
  int32_t holes = 0;  // number of closed holes; 0: mesh is left empty
  // The given vertices and triangles, unchanged and first, followed by those of the patches.
  TriangleMesh mesh;
};

// About 0.1 s for a million triangles without a hole, and a few milliseconds per hole.
FilledMesh fill_holes(const TriangleMesh& mesh, const FillParams& params = {});

// The border as simple closed loops of vertices, in the direction of a patch's triangles. Borders that touch
// at a vertex are separated there; edges of more than two triangles are not borders.
std::vector<std::vector<int32_t>> border_loops(const TriangleMesh& mesh);

}  // namespace focal
