// Exact polyhedral distances by CGAL (S. Xin, G. Wang, "Improving Chen and Han's Algorithm on the Discrete Geodesic Problem",
// 2009), for test programs only: CGAL is never shipped.
#pragma once
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

#include <stdexcept>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace focal_test {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using ShortestPath =
    CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<Kernel, CgalMesh>>;

inline CgalMesh to_cgal(const focal::TriangleMesh& source) {
  CgalMesh mesh;
  for (Eigen::Index v = 0; v < source.positions.rows(); ++v)
    mesh.add_vertex({source.positions(v, 0), source.positions(v, 1), source.positions(v, 2)});
  for (Eigen::Index t = 0; t < source.triangles.rows(); ++t) {
    const auto corner = [&](int i) { return CgalMesh::Vertex_index(source.triangles(t, i)); };
    if (mesh.add_face(corner(0), corner(1), corner(2)) == CgalMesh::null_face())
      throw std::runtime_error("the mesh is not a manifold");
  }
  return mesh;
}

// From one vertex to all.
inline std::vector<double> cgal_distances(const CgalMesh& mesh, int32_t source) {
  ShortestPath path(mesh);
  path.add_source_point(CgalMesh::Vertex_index(source));
  std::vector<double> distances;
  for (const auto vertex : mesh.vertices())
    distances.push_back(path.shortest_distance_to_source_points(vertex).first);
  return distances;
}

}  // namespace focal_test
