// The Delaunay triangulation of a surface over its own vertices, found by flipping edges within the surface: the shape
// stays exactly as it is, the cotangent Laplacian gets no negative weight (M. Fisher, B. Springborn, P. Schroeder,
// A. Bobenko, "An Algorithm for the Construction of Intrinsic Delaunay Triangulations", 2007).
#pragma once
#include "mesh/triangle_mesh.h"

namespace focal {

// Triangles known by their edge lengths. A vertex may be its own neighbour, two triangles may share two edges.
struct IntrinsicTriangulation {
  MatrixX3i triangles;  // m x 3 vertices
  MatrixX3 lengths;     // m x 3: of the edge opposite to corner i
  int32_t layers = 1;   // 2: of the tufted cover, which covers the surface twice
  int64_t flips = 0;
};

// Edges at a boundary stay. Where triangles do not make a surface (see manifold_gluing), of its tufted cover, which has no
// boundary. Lengths are mollified first.
IntrinsicTriangulation intrinsic_delaunay(const TriangleMesh& mesh);

// Adds to all lengths (m x 3, opposite to the corners) what the flattest triangle lacks for any two sides to be longer than
// the third by this share of the mean edge; nothing where none lacks it (N. Sharp, K. Crane, "A Laplacian for Nonmanifold Triangle Meshes", 2020).
void mollify(MatrixX3& lengths, double share);

// As given, without a flip.
IntrinsicTriangulation intrinsic_copy(const TriangleMesh& mesh);

// Area, and half the cotangent at each corner, of a triangle with these edge lengths (opposite to corners 0, 1, 2).
// smallest_area: taken instead of any smaller one, so that slivers stay finite.
struct TriangleMeasure {
  double area;
  Vector3 half_cotangent;
};
TriangleMeasure measure(const Vector3& lengths, double smallest_area);

}  // namespace focal
