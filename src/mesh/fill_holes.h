// Holes closed, so that the analysis sees the surface that a scanner missed: heat, spectra and geodesics change much
// where a surface is open. Borders of simple loops only; whatever cannot be closed cleanly stays open.
#pragma once
#include <vector>

#include "mesh/triangle_mesh.h"

namespace focal {

struct FillParams {
  // Longest border that is closed, of sqrt(area of the mesh). Measured on damaged training shapes: see docs/accuracy.md.
  double longest_border = 1.5;
  // A patch larger than this share of the area of its connected part is no hole but the rim of an open sheet.
  double largest_share = 0.1;
};

struct FilledMesh {
  int32_t holes = 0;  // that were closed; 0: mesh is left empty
  // The given vertices and triangles, unchanged and first, then those of the patches.
  TriangleMesh mesh;
};

// About 0.1 s for a million triangles without a hole, and a few milliseconds a hole.
FilledMesh fill_holes(const TriangleMesh& mesh, const FillParams& params = {});

// The border as simple closed loops of vertices, in the order in which a patch's triangles run along it. Borders that
// touch at a vertex come apart there; edges of more than two triangles are no border.
std::vector<std::vector<int32_t>> border_loops(const TriangleMesh& mesh);

}  // namespace focal
