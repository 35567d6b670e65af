// Welding and cleaning: against the plain way of doing it, on meshes with seams, repeats and needles.
#include "mesh/prepare.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

// Every triangle has corners of its own, some triangles are repeated or turned, some are degenerate.
TriangleMesh messy() {
  const TriangleMesh whole = sphere(4);
  Random random(3);
  std::vector<Eigen::Vector3i> triangles;
  for (int32_t t = 0; t < whole.triangle_count(); ++t) {
    triangles.push_back(whole.triangles.row(t));
    const auto kind = random.below(8);
    if (kind == 0) triangles.push_back(whole.triangles.row(t));
    if (kind == 1)
      triangles.emplace_back(whole.triangles(t, 1), whole.triangles(t, 0), whole.triangles(t, 2));
    if (kind == 2)
      triangles.emplace_back(whole.triangles(t, 0), whole.triangles(t, 0), whole.triangles(t, 2));
  }
  TriangleMesh mesh;
  mesh.positions.resize(3 * triangles.size(), 3);
  mesh.triangles.resize(triangles.size(), 3);
  for (size_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto corner = static_cast<int32_t>(3 * t + i);
      mesh.positions.row(corner) = whole.positions.row(triangles[t][i]);
      if (mesh.positions(corner, 0) == 0 && random.below(2)) mesh.positions(corner, 0) = -0.0;
      mesh.triangles(t, i) = corner;
    }
  return mesh;
}

std::array<double, 3> place(const TriangleMesh& mesh, int32_t v) {
  return {mesh.positions(v, 0) + 0.0, mesh.positions(v, 1) + 0.0, mesh.positions(v, 2) + 0.0};
}

}  // namespace

TEST_CASE("vertices of one place become one, named by the first of them") {
  const PreparedMesh mesh = prepare(messy());
  CHECK(mesh.surface.vertex_count() == sphere(4).vertex_count());
  std::map<std::array<double, 3>, int32_t> first;
  for (int32_t v = 0; v < mesh.source.vertex_count(); ++v) first.try_emplace(place(mesh.source, v), v);
  for (int32_t v = 0; v < mesh.source.vertex_count(); ++v)
    CHECK(mesh.source_vertex[mesh.surface_vertex[v]] == first.at(place(mesh.source, v)));
}

TEST_CASE("of triangles with the same corners the first stays, degenerate ones go") {
  const PreparedMesh mesh = prepare(messy());
  CHECK(mesh.surface.triangle_count() == sphere(4).triangle_count());
  std::set<std::array<int32_t, 3>> seen;
  for (int32_t t = 0; t < mesh.source.triangle_count(); ++t) {
    std::array<int32_t, 3> corners;
    for (int i = 0; i < 3; ++i) corners[i] = mesh.surface_vertex[mesh.source.triangles(t, i)];
    std::sort(corners.begin(), corners.end());
    const bool kept = corners[0] != corners[1] && corners[1] != corners[2] && seen.insert(corners).second;
    CHECK((mesh.surface_triangle[t] >= 0) == kept);
  }
  REQUIRE(!mesh.warnings.empty());
  CHECK(mesh.warnings[0].find("degenerate or repeated") != std::string::npos);
}
