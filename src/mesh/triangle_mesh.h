// A plain triangle mesh.
#pragma once
#include "base/matrix.h"

namespace focal {

struct TriangleMesh {
  MatrixX3 positions;   // n x 3
  MatrixX3i triangles;  // m x 3, 0-based rows of positions, counter-clockwise from outside

  int32_t vertex_count() const { return static_cast<int32_t>(positions.rows()); }
  int32_t triangle_count() const { return static_cast<int32_t>(triangles.rows()); }
};

// A point on the surface: barycentric weights (>= 0, sum 1) of the corners of a triangle.
struct SurfacePoint {
  int32_t triangle = -1;
  Vector3 barycentric = Vector3(1, 0, 0);
};

double surface_area(const TriangleMesh& mesh);
double mean_edge_length(const TriangleMesh& mesh);  // over the undirected edges, each once
Vector3 position_of(const TriangleMesh& mesh, const SurfacePoint& point);
int32_t nearest_corner(const TriangleMesh& mesh, const SurfacePoint& point);  // its vertex

// n x 3: twice the area of the triangles around each vertex, along their mean normal.
MatrixX3 area_normals(const TriangleMesh& mesh);

// Undirected edges, each once, smaller index first, sorted; row e is (a, b).
Edges edges_of(const TriangleMesh& mesh);

}  // namespace focal
