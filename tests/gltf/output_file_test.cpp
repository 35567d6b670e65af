// Files that leave: of the kind that their path promises, with a mesh in the coordinates it came in.
#include "gltf/output_file.h"

#include <doctest/doctest.h>

#include "base/error.h"
#include "surfaces.h"

using namespace focal;

TEST_CASE("a path that promises the other kind of file is refused") {
  for (const char* path : {"a.glb", "a.GLB", "a.vrm", "a", "folder.gltf/a.glb"})
    CHECK_NOTHROW(check_suffix(path, true));
  for (const char* path : {"a.gltf", "a.GLTF", "a.json", "a"}) CHECK_NOTHROW(check_suffix(path, false));
  CHECK_THROWS_AS(check_suffix("a.gltf", true), Error);
  for (const char* path : {"a.glb", "a.Vrm"}) CHECK_THROWS_AS(check_suffix(path, false), Error);
  for (const char* path : {"a.fbx", "a.USDZ", "a.obj"})
    for (const bool is_binary : {true, false}) CHECK_THROWS_AS(check_suffix(path, is_binary), Error);
}

TEST_CASE("a mesh without a file of its own is written as a plain GLB") {
  const TriangleMesh mesh = focal_test::sphere(2);
  const SourceFile file = source_file(nullptr, mesh, "a.glb");
  CHECK(file.document.is_binary());
  CHECK(file.document.files_beside().empty());
  REQUIRE(file.primitives.size() == 1);
  CHECK(file.primitives[0].triangle_count == mesh.triangle_count());
  CHECK_THROWS_AS(source_file(nullptr, mesh, "a.gltf"), Error);
  CHECK(source_file(&file, {}, "b.glb").document.bytes() == file.document.bytes());
}

TEST_CASE("a surface goes back to the coordinates of its source") {
  TriangleMesh mesh = focal_test::sphere(2);
  mesh.positions = (7 * mesh.positions).rowwise() + Eigen::RowVector3d(1, -2, 3);
  const PreparedMesh prepared = prepare(mesh);
  const TriangleMesh again = in_source_coordinates(prepared.surface, prepared);
  for (int32_t v = 0; v < mesh.vertex_count(); ++v)
    CHECK((again.positions.row(prepared.surface_vertex[v]) - mesh.positions.row(v)).norm() < 1e-12);
}
