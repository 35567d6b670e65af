// One closed surface round everything that a mesh shows from outside: the outer shell of any soup of triangles, with no seams,
// doubled faces, inner parts or open borders left.
#pragma once
#include "base/parallel.h"
#include "mesh/triangle_mesh.h"

namespace focal {

struct WrapParams {
  int32_t cells = 160;        // of the grid along the longest side of the mesh, at most
  double area_cells = 30000;  // at most about so many cells hold a part of the surface
};

struct WrappedMesh {
  TriangleMesh mesh;    // one closed manifold part, counter-clockwise from outside, in the units of the input
  double cell = 0;      // length of a grid cell, same unit: what is thinner or closer together merges
  int32_t bridged = 0;  // floating parts joined to the nearest other one
  int32_t left_out = 0;  // small parts far from everything else
};

// A cell belongs to the solid when most of six axis-parallel rays from it say so (F. Nooruddin, G. Turk, "Simplification and
// Repair of Polygonal Models Using Volumetric Techniques", 2003; signed crossings in place of parity, so that parts may
// overlap), or when no path leads out of it between the triangles. Open sheets count as one cell thick. The surface is that
// of surface nets (S. Gibson, "Constrained Elastic Surface Nets", 1998) with vertices at the mean of the exact crossings of
// the grid's edges. The result depends on the geometry; how it is cut into triangles moves a cell here and there, where
// sheets are looked for.
WrappedMesh wrap(const TriangleMesh& mesh, const WrapParams& params, const Execution& execution);

}  // namespace focal
