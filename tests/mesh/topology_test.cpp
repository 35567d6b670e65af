// Edges, fans, borders and orientation on surfaces whose counts are known, and repairs that undo known damage.
#include "mesh/topology.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "mesh/fill_holes.h"
#include "mesh/prepare.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

Topology topology_of(const TriangleMesh& mesh) { return topology_of(mesh, edge_sides(mesh)); }
Orientation orientation_of(const TriangleMesh& mesh) {
  return consistent_orientation(mesh, edge_sides(mesh));
}

TriangleMesh without(const TriangleMesh& mesh, const std::set<int32_t>& triangles) {
  TriangleMesh result = mesh;
  int32_t kept = 0;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    if (!triangles.contains(t)) result.triangles.row(kept++) = mesh.triangles.row(t);
  result.triangles.conservativeResize(kept, 3);
  return result;
}

TriangleMesh both(const TriangleMesh& a, const TriangleMesh& b, const Vector3& offset) {
  TriangleMesh result;
  result.positions.resize(a.vertex_count() + b.vertex_count(), 3);
  result.positions << a.positions, b.positions.rowwise() + offset.transpose();
  result.triangles.resize(a.triangle_count() + b.triangle_count(), 3);
  result.triangles << a.triangles, (b.triangles.array() + a.vertex_count()).matrix();
  return result;
}

// Every two triangles at an edge run along it in opposite ways.
bool agrees(const TriangleMesh& mesh) {
  std::set<std::pair<int32_t, int32_t>> seen;
  for (int32_t s = 0; s < 3 * mesh.triangle_count(); ++s)
    if (!seen.emplace(side_from(mesh.triangles, s), side_to(mesh.triangles, s)).second) return false;
  return true;
}

}  // namespace

TEST_CASE("edges hold all sides along them, as a map finds them") {
  TriangleMesh mesh = sphere(2);
  mesh.triangles.conservativeResize(mesh.triangle_count() + 1, 3);
  mesh.triangles.bottomRows(1) << mesh.triangles(0, 1), mesh.triangles(0, 0), 50;
  std::map<std::pair<int32_t, int32_t>, std::vector<int32_t>> expected;
  for (int32_t s = 0; s < 3 * mesh.triangle_count(); ++s)
    expected[std::minmax({side_from(mesh.triangles, s), side_to(mesh.triangles, s)})].push_back(s);
  const EdgeSides edges = edge_sides(mesh);
  REQUIRE(edges.edge_count() == static_cast<int32_t>(expected.size()));
  int32_t e = 0;
  for (const auto& [ends, sides] : expected) {
    const auto found = edges.of_edge(e++);
    CHECK(std::vector<int32_t>(found.begin(), found.end()) == sides);
  }
}

TEST_CASE("a sound closed surface has nothing to tell") {
  const Topology found = topology_of(sphere(3));
  CHECK(found.nonmanifold_edges == 0);
  CHECK(found.nonmanifold_vertices == 0);
  CHECK(found.boundary_loops == 0);
  CHECK(orientation_of(sphere(3)).flips == 0);
  CHECK(orientation_of(sphere(3)).is_consistent);
}

TEST_CASE("holes, also those that touch, are counted as the loops that are filled") {
  CHECK(topology_of(square(4)).boundary_loops == 1);
  const TriangleMesh whole = sphere(3);
  std::set<int32_t> far_apart = {0, 100, 400};
  CHECK(topology_of(without(whole, far_apart)).boundary_loops == 3);
  // Two triangles that share a vertex only: the holes touch there, and the vertex has two fans.
  int32_t touching = 1;
  const auto shared = [&](int32_t t) {
    int count = 0;
    for (int i = 0; i < 3; ++i) count += (whole.triangles.row(t).array() == whole.triangles(0, i)).any();
    return count;
  };
  while (shared(touching) != 1) ++touching;
  const TriangleMesh holed = without(whole, {0, touching});
  const Topology found = topology_of(holed);
  CHECK(found.nonmanifold_vertices == 1);
  CHECK(border_loops(holed).size() == 2);
  CHECK(found.boundary_loops >= 1);  // the border is one curve, pinched at the vertex, or two
}

TEST_CASE("bow ties and fins are told apart") {
  TriangleMesh pair = both(sphere(2), sphere(2), {2, 0, 0});  // (1, 0, 0) of one is (-1, 0, 0) of the other
  const PreparedMesh tied = prepare(pair);
  CHECK(tied.topology->nonmanifold_vertices == 1);
  CHECK(tied.topology->nonmanifold_edges == 0);
  CHECK(tied.components == 1);
  TriangleMesh finned = sphere(2);
  const int32_t n = finned.vertex_count(), m = finned.triangle_count();
  finned.positions.conservativeResize(n + 1, 3);
  finned.positions.row(n) << 0, 0, 3;
  finned.triangles.conservativeResize(m + 1, 3);
  finned.triangles.row(m) << finned.triangles(0, 0), finned.triangles(0, 1), n;
  const Topology found = topology_of(finned);
  CHECK(found.nonmanifold_edges == 1);
  CHECK(found.nonmanifold_vertices == 0);
  CHECK(found.boundary_loops == 1);
}

TEST_CASE("whatever is turned over at random is turned back") {
  const TriangleMesh right = with_radius(sphere(3), lump);
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    TriangleMesh mesh = right;
    std::vector<char> turned(mesh.triangle_count(), 0);
    for (int32_t t = 0; t < mesh.triangle_count(); ++t)
      if (random.below(5) < seed) turned[t] = 1, turn_over(mesh, t);
    const Orientation found = orientation_of(mesh);
    CHECK(found.is_consistent);
    CHECK(found.flipped == turned);  // closed: to the outside, however many were wrong
    CHECK(found.flips == std::count(turned.begin(), turned.end(), 1));
  }
}

TEST_CASE("each closed part faces outwards, an open one where most of it faced") {
  TriangleMesh inside_out = sphere(2);
  for (int32_t t = 0; t < inside_out.triangle_count(); ++t) turn_over(inside_out, t);
  const TriangleMesh two = both(sphere(2), inside_out, {5, 0, 0});
  const Orientation found = orientation_of(two);
  for (int32_t t = 0; t < two.triangle_count(); ++t)
    CHECK((found.flipped[t] != 0) == (t >= inside_out.triangle_count()));
  TriangleMesh sheet = square(4);
  for (int32_t t = 0; t < sheet.triangle_count(); ++t)
    if (t % 3 == 0) turn_over(sheet, t);
  const Orientation flat = orientation_of(sheet);
  for (int32_t t = 0; t < sheet.triangle_count(); ++t) CHECK((flat.flipped[t] != 0) == (t % 3 == 0));
}

TEST_CASE("a Moebius strip is told, and left as it is") {
  const TriangleMesh strip = moebius_strip(30, 4);
  const Orientation found = orientation_of(strip);
  CHECK_FALSE(found.is_consistent);
  CHECK(found.flips == 0);
  CHECK(topology_of(strip).boundary_loops == 1);  // of one border, unlike a cylinder
  const PreparedMesh mesh = prepare(strip);
  CHECK_FALSE(mesh.is_oriented);
  REQUIRE(!mesh.warnings.empty());
  CHECK(mesh.warnings.back().find("Moebius") != std::string::npos);
}

TEST_CASE("points keep their place in the caller's corners when their triangle is turned over") {
  TriangleMesh mesh = with_radius(sphere(3), lump);
  Random random(9);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    if (random.below(2)) turn_over(mesh, t);
  const PreparedMesh prepared = prepare(mesh);
  CHECK(flipped_triangles(prepared) > 100);
  CHECK(agrees(prepared.surface));
  CHECK(prepared.source.triangles == mesh.triangles);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const SurfacePoint point{t, Vector3(0.5, 0.3, 0.2)};
    const SurfacePoint there = to_surface(prepared, point), back = to_source(prepared, there);
    CHECK(back.triangle == t);
    CHECK(back.barycentric == point.barycentric);
    const Vector3 place = prepared.centre + prepared.scale * position_of(prepared.surface, there);
    CHECK((place - position_of(mesh, point)).norm() < 1e-12);
  }
}

TEST_CASE("leniently, what is invalid is left out and all else keeps its number") {
  const TriangleMesh whole = with_radius(sphere(3), lump);
  TriangleMesh mesh = whole;
  mesh.positions(7, 1) = std::nan("");
  mesh.triangles(100, 2) = -1;
  mesh.triangles(200, 0) = mesh.vertex_count();
  CHECK_THROWS(prepare(mesh));
  const PreparedMesh prepared = prepare(mesh, {.lenient = true});
  std::set<int32_t> expected = {100, 200};
  for (int32_t t = 0; t < whole.triangle_count(); ++t)
    if ((whole.triangles.row(t).array() == 7).any()) expected.insert(t);
  CHECK(prepared.invalid_triangles == static_cast<int64_t>(expected.size()));
  CHECK(degenerate_triangles(prepared) == 0);
  CHECK(prepared.surface_vertex[7] == -1);
  CHECK(prepared.warnings[0].find("left out") != std::string::npos);
  for (int32_t t = 0; t < whole.triangle_count(); ++t) {
    CHECK((prepared.surface_triangle[t] < 0) == expected.contains(t));
    if (prepared.surface_triangle[t] < 0)
      CHECK(prepared.source.triangles.row(t).isZero());
    else
      for (int i = 0; i < 3; ++i)
        CHECK(prepared.source_vertex[prepared.surface.triangles(prepared.surface_triangle[t], i)] ==
              whole.triangles(t, i));
  }
  CHECK(prepare(whole, {.lenient = true}).surface.positions == prepare(whole).surface.positions);
}
