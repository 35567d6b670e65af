// The few geometric types that every stage of the creature maker shares.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace creatures {

using Vec3 = Eigen::Vector3d;
using Triangle = std::array<int, 3>;

// Triangles are counter-clockwise seen from outside. Units: about a metre; y is up, z is forward, x is the
// creature's own left.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
};

inline Vec3 mirrored(const Vec3& p) { return {-p.x(), p.y(), p.z()}; }

}  // namespace creatures
