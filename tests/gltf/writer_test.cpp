// What is written is read back, and refused when it could not be.
#include <doctest/doctest.h>

#include <limits>

#include "base/error.h"
#include "gltf/document.h"
#include "gltf/gltf_builder.h"
#include "gltf/preflight.h"

using namespace focal;
using namespace focal_test;

namespace {

TriangleMesh tetrahedron_mesh() { return read_gltf_memory(tetrahedron().glb()).mesh; }

Status status_of(const TriangleMesh& mesh, const RowMatrixf& colours = {}) {
  try {
    write_glb(mesh, colours);
    return Status::ok;
  } catch (const Error& error) {
    return error.status();
  }
}

}  // namespace

TEST_CASE("a written mesh is read back with its name, normals and colours") {
  const TriangleMesh mesh = tetrahedron_mesh();
  RowMatrixf colours(4, 3);
  colours << 0, 0.5, 1, -3, 7, std::numeric_limits<float>::quiet_NaN(), 1, 0, 0, 0, 0, 1;
  const auto bytes = write_glb(mesh, colours, "a \"b\" é");
  const GltfMesh again = read_gltf_memory(bytes);
  CHECK(again.mesh.positions == mesh.positions);
  CHECK(again.mesh.triangles == mesh.triangles);
  CHECK(again.warnings.empty());
  const GltfContainer container = open_container(bytes, {});
  const JsonDocument document = parse_gltf(container, {});
  const json& root = document.root();
  CHECK(root["nodes"][0]["name"] == "a \"b\" é");
  CHECK(root["accessors"][1]["max"] == json({1.0, 1.0, 1.0}));
  const auto* colour = container.bin.data() + root["bufferViews"][3]["byteOffset"].get<size_t>();
  CHECK(std::vector(colour, colour + 8) == std::vector{std::byte(0), std::byte(128), std::byte(255),
                                                       std::byte(255), std::byte(0), std::byte(255),
                                                       std::byte(0), std::byte(255)});
  float normal[3];  // of vertex 0, where three equal right triangles meet
  std::memcpy(normal, container.bin.data() + root["bufferViews"][2]["byteOffset"].get<size_t>(), 12);
  for (const float component : normal) CHECK(component == doctest::Approx(-1 / std::sqrt(3.0)));
}

TEST_CASE("a mesh that glTF cannot hold is refused") {
  TriangleMesh mesh = tetrahedron_mesh();
  CHECK(status_of({}) == Status::invalid_mesh);
  CHECK(status_of(mesh, RowMatrixf::Zero(3, 3)) == Status::invalid_argument);
  CHECK(status_of(mesh, RowMatrixf::Zero(4, 4)) == Status::invalid_argument);
  mesh.positions(0, 0) = 1e300;
  CHECK(status_of(mesh) == Status::invalid_mesh);
  mesh = tetrahedron_mesh();
  mesh.triangles(1, 1) = 4;
  CHECK(status_of(mesh) == Status::invalid_mesh);
}

TEST_CASE("a .glb of more than 4 GiB is refused before memory is taken for it") {
  const std::byte one{};
  try {
    glb_bytes("{}", std::span(&one, size_t{1} << 32));  // only its size is looked at
    FAIL("it was written");
  } catch (const Error& error) {
    CHECK(error.status() == Status::unsupported);
  }
}
