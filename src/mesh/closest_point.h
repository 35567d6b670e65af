// The surface point nearest to a given place, on the side that faces the same way.
#pragma once
#include <span>
#include <vector>

#include "base/parallel.h"
#include "mesh/triangle_mesh.h"

namespace focal {

struct SurfaceQuery {
  Vector3 position;
  Vector3
      normal;  // only triangles within 90 degrees of it count, so that thin parts keep their two sides; 0: all
};

// One a query. radius: where a few queries look first, about twice the distance expected; widened until something is found.
// Hundreds of queries go through a tree of triangles instead.
std::vector<SurfacePoint> closest_points(const TriangleMesh& mesh, std::span<const SurfaceQuery> queries,
                                         double radius, const Execution& execution = Execution().inner());

// Barycentric weights of the point of the triangle abc nearest to p (Ericson, "Real-Time Collision Detection", 2005).
Vector3 closest_on_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace focal
