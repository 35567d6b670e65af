// The discrete operators of a triangle mesh (U. Pinkall, K. Polthier, "Computing Discrete Minimal Surfaces and Their
// Conjugates", 1993).
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace focal {

struct Operators {
  // m x 3: the triangles of the mesh, or of its intrinsic Delaunay triangulation; two for each where that is
  // a tufted cover, with halved cotangents and areas.
  MatrixX3i triangles;
  SparseMatrix L;  // n x n cotangent Laplacian, positive semi-definite, rows sum to 0; no unit
  Vector mass;     // n, lumped (a third of the area around each vertex), > 0; in units of area
  // m x 3: half the cotangent at corner i.
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> half_cotangent;
  Vector face_area;  // m
  double area = 0, mean_edge = 0;
};

// bridges: pairs of vertices joined by an edge of the Laplacian, so that separate parts are connected.
// delaunay: use the intrinsic Delaunay triangulation, which is robust to thin and obtuse triangles and to
// edges of more than two triangles; no weight is negative. Else the triangles as they are.
Operators make_operators(const TriangleMesh& mesh, std::span<const std::pair<int32_t, int32_t>> bridges = {},
                         bool delaunay = false);

// Vertices connected with a vertex along the edges of L inside the ball of this radius around it, itself
// first.
std::vector<int32_t> connected_ball(const SparseMatrix& L, const MatrixX3& positions, int32_t centre,
                                    double radius);

// Gradient of the vertex function u (n) in each triangle, m x 3.
MatrixX3 gradient(const TriangleMesh& mesh, const Vector& u);
// Integrated divergence at the vertices (n) of the field X (m x 3), constant in each triangle. L = -divergence gradient.
Vector divergence(const TriangleMesh& mesh, const MatrixX3& X);
// Unit normal of each triangle, m x 3; zero where it has no area.
MatrixX3 face_normals(const TriangleMesh& mesh);

}  // namespace focal
