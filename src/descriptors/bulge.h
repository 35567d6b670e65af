// The bulge of a surface around a point, at several radii: it distinguishes front from back where distances
// along the surface do not.
#pragma once
#include <array>

#include "base/parallel.h"
#include "mesh/triangle_mesh.h"

namespace focal {

inline constexpr std::array<double, 4> bulge_radii = {0.03, 0.06, 0.1, 0.16};  // in sqrt(area)

// vertices x radii: the area-weighted mean of n . (x - p) / r over the surface points x within r of p whose
// normals agree with n. Negative where the surface is convex, within -1..1. It hardly changes with the pose,
// and is the same on the left and the right. normals: unit length; mass: the area of each vertex. Above about
// 4,000 vertices a subset represents the others.
RowMatrixf bulge(const TriangleMesh& mesh, const MatrixX3& normals, const Vector& mass,
                 const Execution& execution);

}  // namespace focal
