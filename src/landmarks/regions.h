// Regions around landmarks: geodesic distances from points of a surface to all vertices of the caller's mesh.
#pragma once
#include <vector>

#include "base/parallel.h"
#include "geodesics/heat_method.h"
#include "mesh/proxy.h"

namespace focal {

// Solved on the proxy, so the cost hardly grows with the mesh: about 50 ms to create, 10 ms per point.
// Immutable and thread-safe.
class DistanceFields {
 public:
  DistanceFields(Proxy proxy, const Execution& execution);

  // Distances in the caller's units, one for each vertex of mesh.source; infinity where no triangle uses the
  // vertex. The point is on mesh.source, in a triangle that the surface has.
  std::vector<float> from(const SurfacePoint& source_point, const Execution& execution) const;

 private:
  Proxy proxy_;
  HeatMethod heat_;
  std::vector<SurfacePoint> places_;  // of the full surface's vertices on the coarse one
};

// 1 within the radius, 0 outside, with a linear transition of width `border`.
std::vector<float> membership(const std::vector<float>& distances, double radius, double border);

}  // namespace focal
