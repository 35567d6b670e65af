// The inside of a surface: the centre of a limb below a point of its skin.
#pragma once
#include "mesh/ray_caster.h"

namespace focal {

// About 1 inside, 0 outside, in between near holes, which therefore need not be closed. Time is linear in the
// number of triangles. A. Jacobson, L. Kavan, O. Sorkine-Hornung, "Robust Inside-Outside Segmentation using
// Generalized Winding Numbers", 2013.
double winding_number(const TriangleMesh& mesh, const Vector3& point);

// The centre of the cross-section below a point of the surface, perpendicular to the direction of the longest
// extent there: on a limb a point of its axis. outward: the unit normal of the surface there.
Vector3 section_centre(const RayCaster& surface, const Vector3& point, const Vector3& outward);

// The point itself if it is inside; otherwise the centre of the cross-section below the nearest vertex.
Vector3 drawn_inside(const RayCaster& surface, const Vector3& point);

}  // namespace focal
