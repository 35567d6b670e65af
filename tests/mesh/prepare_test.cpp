// Welding and cleaning: against the plain way of doing it, on meshes with seams, repeats and needles.
#include "mesh/prepare.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
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

TEST_CASE(
    "a mesh is wrapped where it has several parts or many edges of more than two triangles, and where it is "
    "asked for") {
  const TriangleMesh one = sphere(3);
  TriangleMesh two = one;
  two.positions.conservativeResize(2 * one.vertex_count(), 3);
  two.triangles.conservativeResize(2 * one.triangle_count(), 3);
  two.positions.bottomRows(one.vertex_count()) = one.positions.rowwise() + Eigen::RowVector3d(0, 3, 0);
  two.triangles.bottomRows(one.triangle_count()) = one.triangles.array() + one.vertex_count();
  const auto is_wrapped = [](const TriangleMesh& mesh,
                             AnalysedSurface analysed = AnalysedSurface::automatic) {
    return prepare(mesh, {.analysed = analysed}).is_wrapped;
  };
  CHECK_FALSE(is_wrapped(one));
  CHECK(is_wrapped(one, AnalysedSurface::wrapped));
  CHECK(is_wrapped(two));
  CHECK_FALSE(is_wrapped(two, AnalysedSurface::as_it_is));
  CHECK(is_wrapped(book(2)));         // 4 edges of three triangles, 65 vertices
  CHECK_FALSE(is_wrapped(book(20)));  // 40 among 4,961
  for (const AnalysedSurface analysed : {AnalysedSurface::automatic, AnalysedSurface::as_it_is}) {
    const PreparedMesh mesh = prepare(two, {.analysed = analysed});
    CHECK(bridges_of(mesh).size() == 3);  // for those who look at the triangles themselves
    REQUIRE(mesh.warnings.size() == 1);
    CHECK(mesh.warnings[0].find(mesh.is_wrapped ? "a closed surface round them all"
                                                : "bridged at the nearest vertices") != std::string::npos);
  }
}

TEST_CASE("a wrapped mesh lies where the mesh lies") {
  TriangleMesh source = sphere(4);
  source.positions = ((20 * source.positions).rowwise() + Eigen::RowVector3d(3, 100, -7)).eval();
  const PreparedMesh mesh = prepare(source, {.analysed = AnalysedSurface::wrapped});
  const PreparedMesh shell = wrapped(mesh);
  CHECK_FALSE(shell.is_wrapped);
  CHECK(shell.components == 1);
  // Its source is in the coordinates of the surface: of area 1, round the centre.
  const Vector radius = shell.source.positions.rowwise().norm();
  CHECK((radius.array() - 1 / std::sqrt(4 * std::numbers::pi)).abs().maxCoeff() < 0.005);
  CHECK(shell.scale == doctest::Approx(1).epsilon(0.01));
}
