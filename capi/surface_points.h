// Points of a surface on their way through the border: the caller's numbers, checked, and back.
#pragma once
#include <string>

#include "focal/focal.h"
#include "mesh/prepare.h"

namespace focal {

// On mesh.surface. Weights are scaled to sum 1; a point in a triangle that was dropped moves to its heaviest
// corner. Throws invalid_landmark: no such triangle or vertex, weights that are not >= 0, nothing of the
// surface there. `name` says which point it is.
SurfacePoint point_in(const PreparedMesh& mesh, const focal_surface_point& point, const std::string& name);
SurfacePoint vertex_in(const PreparedMesh& mesh, uint32_t vertex, const std::string& name);

// In the caller's numbers.
focal_surface_point point_out(const SurfacePoint& source_point);
void position_out(const Vector3& position, float* out);

}  // namespace focal
