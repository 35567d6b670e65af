// What a ray meets first, on a mesh that is asked often.
#pragma once
#include <limits>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace focal {

// A hierarchy of boxes round the triangles, halved at the median. It keeps its own copy of the mesh.
class RayCaster {
 public:
  explicit RayCaster(TriangleMesh mesh);

  struct Hit {
    double distance = std::numeric_limits<double>::infinity();  // in lengths of the ray's direction
    int32_t triangle = -1;
  };
  // The first triangle that origin + distance * direction meets, from either side, at 0 < distance < farthest.
  // Thread-safe. T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
  Hit first_hit(const Vector3& origin, const Vector3& direction,
                double farthest = std::numeric_limits<double>::infinity()) const;

  const TriangleMesh& mesh() const { return mesh_; }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int32_t first = 0,
            count = 0;  // of order_; count 0: an inner node, whose halves are the next node and `second`
    int32_t second = 0;
  };
  int32_t build(int32_t first, int32_t count, const MatrixX3& centres);

  TriangleMesh mesh_;
  std::vector<int32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace focal
