// exact_geodesics MESH.glb FILE VERTEX...: exact polyhedral distances from each vertex to all, by CGAL (S.
// Xin, G. Wang, "Improving Chen and Han's Algorithm on the Discrete Geodesic Problem", 2009). A test program:
// CGAL is never shipped.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

#include <iostream>

#include "gltf/reader.h"
#include "raw_numbers.h"

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using ShortestPath = CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<Kernel, Mesh>>;

namespace {

Mesh to_cgal(const focal::TriangleMesh& source) {
  Mesh mesh;
  for (const auto& p : source.positions.rowwise()) mesh.add_vertex({p[0], p[1], p[2]});
  for (const auto& t : source.triangles.rowwise())
    if (mesh.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2])) ==
        Mesh::null_face())
      throw std::runtime_error("the mesh is not a manifold");
  return mesh;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) throw std::runtime_error("usage: exact_geodesics MESH.glb FILE VERTEX...");
  const Mesh mesh = to_cgal(focal::read_gltf(argv[1]).mesh);
  std::vector<double> distances;
  for (const int32_t source : focal_test::vertices_from(3, argc, argv)) {
    ShortestPath path(mesh);
    path.add_source_point(Mesh::Vertex_index(source));
    for (const auto vertex : mesh.vertices())
      distances.push_back(path.shortest_distance_to_source_points(vertex).first);
  }
  focal_test::write_raw(argv[2], distances);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "exact_geodesics: " << error.what() << '\n';
  return 1;
}
