// Nearest surface points to given positions, on the side with a similar normal.
#pragma once
#include <span>
#include <vector>

#include "base/parallel.h"
#include "mesh/triangle_mesh.h"

namespace focal {

struct SurfaceQuery {
  Vector3 position;
  // Only triangles within 90 degrees of it count, so that the two sides of thin parts are kept apart; 0: all
  // triangles.
  Vector3 normal;
};

// One result per query. radius: initial search radius for a few queries, about twice the expected distance;
// increased until something is found. Hundreds of queries use a tree of triangles instead.
std::vector<SurfacePoint> closest_points(const TriangleMesh& mesh, std::span<const SurfaceQuery> queries,
                                         double radius, const Execution& execution = Execution().inner());

// Barycentric weights of the point of the triangle abc nearest to p (Ericson, "Real-Time Collision Detection", 2005).
Vector3 closest_on_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace focal
