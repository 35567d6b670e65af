// What the report page shows of a mesh: the same surface, small enough, packed so that it can be unpacked.
#include "shown_mesh.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

using namespace focal_cli;

namespace {

// A grid of n x n squares in which every triangle has corners of its own, as along seams.
Mesh seamed_grid(const focal_context* context, uint32_t n) {
  std::vector<float> positions;
  std::vector<uint32_t> triangles;
  const auto corner = [&](uint32_t x, uint32_t y) {
    triangles.push_back(static_cast<uint32_t>(positions.size() / 3));
    const auto u = static_cast<float>(x), v = static_cast<float>(y);
    positions.insert(positions.end(), {u, v, 0.1f * std::sin(u)});
  };
  for (uint32_t x = 0; x < n; ++x) {
    for (uint32_t y = 0; y < n; ++y) {
      corner(x, y), corner(x + 1, y), corner(x + 1, y + 1);
      corner(x, y), corner(x + 1, y + 1), corner(x, y + 1);
    }
  }
  auto desc = initialised(focal_mesh_desc_init);
  desc.positions = positions.data();
  desc.vertex_count = positions.size() / 3;
  desc.indices = triangles.data();
  desc.index_count = triangles.size();
  return owned<Mesh>(focal_mesh_create, context, &desc, nullptr);
}

Context make_context() {
  const auto params = initialised(focal_context_params_init);
  return owned<Context>(focal_context_create, &params);
}

}  // namespace

TEST_CASE("base64 as in RFC 4648") {
  CHECK(base64("").empty());
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64(std::string_view("\0\xff\x80", 3)) == "AP+A");
}

TEST_CASE("vertices that lie in one place are shown once, and no triangle is lost") {
  const Context context = make_context();
  const Mesh mesh = seamed_grid(context.get(), 8);
  const ShownMesh shown = shown_mesh(mesh.get(), 1000);
  CHECK(shown.vertices.size() == 81);
  CHECK(shown.triangles.size() == 3 * 2 * 64);
  const float* positions = focal_mesh_positions(mesh.get());
  for (size_t i = 0; i < shown.triangles.size(); ++i) {  // the same corners in the same order
    for (size_t axis = 0; axis < 3; ++axis) {
      CHECK(positions[3 * shown.vertices[shown.triangles[i]] + axis] == positions[3 * i + axis]);
    }
  }
}

TEST_CASE("a mesh too large to show becomes about as large as asked for, over its own vertices") {
  const Context context = make_context();
  const Mesh mesh = seamed_grid(context.get(), 60);
  const ShownMesh shown = shown_mesh(mesh.get(), 800);
  CHECK(shown.vertices.size() < 1000);
  CHECK(shown.vertices.size() > 400);
  const std::set<uint32_t> different(shown.vertices.begin(), shown.vertices.end());
  CHECK(different.size() == shown.vertices.size());
}

TEST_CASE("a page of many meshes or landmarks shows fewer vertices, and none becomes shapeless") {
  CHECK(shown_vertices_for(1, 10) == 6000);
  CHECK(shown_vertices_for(28, 13) > 5000);
  CHECK(shown_vertices_for(200, 36) < 1200);
  CHECK(shown_vertices_for(100000, 36) == 400);
}
