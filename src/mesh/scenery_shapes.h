// The two shapes of scenery: a flat sheet and a convex body.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "mesh/box.h"
#include "mesh/triangle_mesh.h"

namespace focal {

struct FlatSheet {
  Vector3 normal = Vector3::UnitZ(), centre = Vector3::Zero();
  Vector3 u = Vector3::UnitX(), v = Vector3::UnitY();  // orthonormal, across the normal
  std::vector<Eigen::Vector2d> outline;  // convex, counter-clockwise, in u and v from the centre
  double outline_area = 0;
};

// Empty unless the triangles are flat (2 % of their smaller width) and fill their convex outline.
std::optional<FlatSheet> flat_sheet(const TriangleMesh& mesh, std::span<const int32_t> triangles);

double polygon_area(std::span<const Eigen::Vector2d> polygon);
// Counter-clockwise, by A. Andrew's monotone chain (1979).
std::vector<Eigen::Vector2d> convex_outline(std::vector<Eigen::Vector2d> points);

Eigen::Vector2d on_sheet(const FlatSheet& sheet, const Vector3& point);
// margin: a distance by which the point may be outside.
bool covers(const FlatSheet& sheet, const Vector3& point, double margin);

struct HalfSpace {
  Vector3 normal = Vector3::UnitX();
  double offset = 0;  // normal . point <= offset inside
};

struct ConvexBody {
  std::vector<HalfSpace> sides;
  Box box;
  double share = 0;  // of the area: triangles with the whole shape on one side; 1: convex

  bool contains(const Vector3& point) const;
};

// Estimated from a few hundred of the triangles.
ConvexBody convex_body(const TriangleMesh& mesh, std::span<const int32_t> triangles);

}  // namespace focal
