// One closed surface around everything that is visible of a mesh from outside: the outer shell of any
// triangle soup, without seams, doubled faces, inner parts or open borders.
#pragma once
#include "base/parallel.h"
#include "mesh/triangle_mesh.h"

namespace focal {

struct WrapParams {
  int32_t cells = 160;        // maximum along the longest side of the mesh
  double area_cells = 30000;  // approximate maximum number of cells that contain a part of the surface
};

struct WrappedMesh {
  // One closed manifold component, counter-clockwise from outside, in the units of the input.
  TriangleMesh mesh;
  double cell = 0;       // length of a grid cell, same unit: thinner or closer parts merge
  int32_t bridged = 0;   // floating parts joined to the nearest other one
  int32_t left_out = 0;  // small parts far from everything else
};

// A cell belongs to the solid when the majority of six axis-parallel rays from it agree (F. Nooruddin, G.
// Turk, "Simplification and Repair of Polygonal Models Using Volumetric Techniques", 2003; signed crossings
// instead of parity, so that parts may overlap), or when no path leads out of it between the triangles. Open
// sheets count as one cell thick. The surface is a surface net (S. Gibson, "Constrained Elastic Surface
// Nets", 1998) with vertices at the mean of the exact crossings of the grid's edges. The result depends on
// the geometry; where sheets are detected, the triangulation can change single cells.
WrappedMesh wrap(const TriangleMesh& mesh, const WrapParams& params, const Execution& execution);

}  // namespace focal
