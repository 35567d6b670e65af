// Mesh simplification.
#pragma once
#include "base/parallel.h"
#include "mesh/triangle_mesh.h"

namespace focal {

// A mesh of about this number of the mesh's vertices, chosen by quadric error (M. Garland, P. Heckbert,
// "Surface Simplification Using Quadric Error Metrics", 1997). Checks for cancellation every few ten thousand
// vertices.
TriangleMesh decimate(const TriangleMesh& mesh, int32_t vertices, const Execution& execution);

}  // namespace focal
