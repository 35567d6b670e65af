// From the implicit body to a first closed triangle mesh.
#pragma once
#include "body.h"
#include "geometry.h"

namespace creatures {

// Marching tetrahedra on a lattice of spacing `cell` that is turned by `rotation` and moved by `shift` (in
// cells): the result is closed and manifold whatever the body, and different for each lattice.
Mesh polygonise(const Body& body, double cell, const Eigen::Quaterniond& rotation, const Vec3& shift);

}  // namespace creatures
