// What lies inside a surface: the middle of a limb under a point of its skin.
#pragma once
#include "mesh/ray_caster.h"

namespace focal {

// About 1 inside, 0 outside, in between near holes, which so need no closing. Time grows with the triangles.
// A. Jacobson, L. Kavan, O. Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized Winding Numbers", 2013.
double winding_number(const TriangleMesh& mesh, const Vector3& point);

// The centre of the cross-section under a point of the surface, across the way that the body is longest there: on a limb a
// point of its axis. outward: the surface's normal there, of length 1.
Vector3 section_centre(const RayCaster& surface, const Vector3& point, const Vector3& outward);

// The point itself when it lies inside; else the centre of the cross-section under the nearest vertex.
Vector3 drawn_inside(const RayCaster& surface, const Vector3& point);

}  // namespace focal
