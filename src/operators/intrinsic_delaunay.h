// The Delaunay triangulation of a surface over its own vertices, computed by intrinsic edge flips: the shape
// does not change, and the cotangent Laplacian gets no negative weights (M. Fisher, B. Springborn, P.
// Schroeder, A. Bobenko, "An Algorithm for the Construction of Intrinsic Delaunay Triangulations", 2007).
#pragma once
#include "mesh/triangle_mesh.h"

namespace focal {

// Triangles given by their edge lengths. A vertex may be its own neighbour, two triangles may share two
// edges.
struct IntrinsicTriangulation {
  MatrixX3i triangles;  // m x 3 vertices
  MatrixX3 lengths;     // m x 3: of the edge opposite to corner i
  int32_t layers = 1;   // 2: a tufted cover, which covers the surface twice
  int64_t flips = 0;
};

// Edges at a boundary are not flipped. Where the triangles are not a manifold (see manifold_gluing), uses the
// tufted cover, which has no boundary. Lengths are mollified first.
IntrinsicTriangulation intrinsic_delaunay(const TriangleMesh& mesh);

// Adds one amount to all lengths (m x 3, opposite to the corners), the smallest for which in every triangle
// any two sides exceed the third by this share of the mean edge; nothing where that holds already (N. Sharp,
// K. Crane, "A Laplacian for Nonmanifold Triangle Meshes", 2020).
void mollify(MatrixX3& lengths, double share);

// The given triangles, without flips.
IntrinsicTriangulation intrinsic_copy(const TriangleMesh& mesh);

// Area, and half the cotangent at each corner, of a triangle with these edge lengths (opposite to corners 0,
// 1, 2). smallest_area: lower limit of the area, so that slivers stay finite.
struct TriangleMeasure {
  double area;
  Vector3 half_cotangent;
};
TriangleMeasure measure(const Vector3& lengths, double smallest_area);

}  // namespace focal
