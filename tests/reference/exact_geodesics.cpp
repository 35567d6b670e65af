// exact_geodesics MESH.glb FILE VERTEX...: exact polyhedral distances from each vertex to all, by CGAL.
#include <iostream>

#include "cgal_geodesics.h"
#include "gltf/document.h"
#include "raw_numbers.h"

int main(int argc, char** argv) try {
  if (argc < 4) throw std::runtime_error("usage: exact_geodesics MESH.glb FILE VERTEX...");
  const auto mesh = focal_test::to_cgal(focal::GltfDocument::open(argv[1]).mesh().mesh);
  std::vector<double> distances;
  for (const int32_t source : focal_test::vertices_from(3, argc, argv)) {
    const auto row = focal_test::cgal_distances(mesh, source);
    distances.insert(distances.end(), row.begin(), row.end());
  }
  focal_test::write_raw(argv[2], distances);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "exact_geodesics: " << error.what() << '\n';
  return 1;
}
