// The paper's extrinsic symmetry plane: N. J. Mitra, L. J. Guibas, M. Pauly, "Partial and Approximate Symmetry
// Detection for 3D Geometry", 2006, reduced to the dominant reflection.
#pragma once
#include "base/parallel.h"
#include "mesh/triangle_mesh.h"

namespace focal {

struct SymmetryPlane {
  Vector3 normal = Vector3::UnitX();  // unit length; the sign has no meaning
  double offset = 0;                  // the plane is {x : normal . x = offset}
  double support = 0;  // 0..1: fraction of the sampled points whose reflection is on the surface
};

SymmetryPlane symmetry_plane(const TriangleMesh& mesh, uint64_t seed, const Execution& execution);

}  // namespace focal
