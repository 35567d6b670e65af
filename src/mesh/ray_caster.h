// First intersections of rays with a mesh, for many rays per mesh.
#pragma once
#include <limits>
#include <utility>

#include "mesh/triangle_mesh.h"
#include "mesh/triangle_tree.h"

namespace focal {

// Keeps its own copy of the mesh.
class RayCaster {
 public:
  explicit RayCaster(TriangleMesh mesh, const Execution& execution = Execution().inner())
      : mesh_(std::move(mesh)), tree_(mesh_, execution) {}

  struct Hit {
    double distance = std::numeric_limits<double>::infinity();  // in multiples of the direction's length
    int32_t triangle = -1;
  };
  // The first triangle that origin + distance * direction hits, from either side, at 0 < distance < farthest.
  // Thread-safe. T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
  Hit first_hit(const Vector3& origin, const Vector3& direction,
                double farthest = std::numeric_limits<double>::infinity()) const;

  const TriangleMesh& mesh() const { return mesh_; }

 private:
  TriangleMesh mesh_;
  TriangleTree tree_;
};

}  // namespace focal
