// Borders that nearly meet: parts and soups of a sphere, pulled apart by less and by more than what is joined.
#include "mesh/stitch.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <map>

#include "base/random.h"
#include "mesh/components.h"
#include "mesh/prepare.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

const double diagonal = std::sqrt(12.0);  // of the box of a sphere of radius 1

// The sphere's triangles with corners of their own where cut(triangle) differs, each copy moved at random by up to `noise`.
template <class Cut>
TriangleMesh apart(const TriangleMesh& whole, double noise, Cut&& cut) {
  Random random(7);
  std::map<std::pair<int32_t, int32_t>, int32_t> copies;
  std::vector<Vector3> places;
  TriangleMesh result;
  result.triangles.resize(whole.triangle_count(), 3);
  for (int32_t t = 0; t < whole.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto [copy, is_new] =
          copies.try_emplace({whole.triangles(t, i), cut(t)}, static_cast<int32_t>(places.size()));
      if (is_new) {
        Vector3 shift(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
        places.push_back(whole.positions.row(whole.triangles(t, i)).transpose() + noise * shift.normalized());
      }
      result.triangles(t, i) = copy->second;
    }
  result.positions.resize(static_cast<Eigen::Index>(places.size()), 3);
  for (size_t v = 0; v < places.size(); ++v)
    result.positions.row(static_cast<Eigen::Index>(v)) = places[v].transpose();
  return result;
}

TriangleMesh halves(const TriangleMesh& whole, double noise) {
  return apart(whole, noise, [&](int32_t t) {
    double height = 0;
    for (int i = 0; i < 3; ++i) height += whole.positions(whole.triangles(t, i), 1);
    return height > 0 ? 1 : 0;
  });
}

TriangleMesh soup(const TriangleMesh& whole, double noise) {
  return apart(whole, noise, [](int32_t t) { return t; });
}

}  // namespace

TEST_CASE("parts that meet within a rounding error or a tenth of a millimetre are one closed surface") {
  const TriangleMesh whole = sphere(4);
  for (const double noise : {0.0, 1e-7, 1e-5, 0.9e-4})
    for (const bool is_soup : {false, true}) {
      CAPTURE(noise);
      CAPTURE(is_soup);
      TriangleMesh mesh = (is_soup ? soup : halves)(whole, noise * diagonal);
      mesh.positions.rowwise() += Eigen::RowVector3d(4000, -3000, 1e5);  // far from the origin
      const PreparedMesh prepared = prepare(mesh);
      CHECK(prepared.components == 1);
      CHECK(prepared.topology->boundary_loops == 0);
      CHECK(prepared.surface.vertex_count() == whole.vertex_count());
      CHECK(prepared.surface.triangle_count() == whole.triangle_count());
      CHECK_FALSE(prepared.is_wrapped);
      for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
        const int32_t first = prepared.source_vertex[prepared.surface_vertex[v]];
        CHECK((mesh.positions.row(v) - mesh.positions.row(first)).norm() < 2e-4 * diagonal);
        CHECK(first <= v);
      }
    }
}

TEST_CASE("a gap stays one, and so do borders whose triangles are smaller than it") {
  for (const double gap : {1.5e-4, 3e-4}) {
    TriangleMesh mesh = halves(sphere(4), 0);
    const Components parts = components_of(mesh);
    for (int32_t v = 0; v < mesh.vertex_count(); ++v)
      if (parts.of_vertex[v] == 1) mesh.positions(v, 1) += gap * diagonal;
    CHECK(prepare(mesh).components == (gap < 2e-4 ? 1 : 2));
  }
  const TriangleMesh fine = halves(sphere(4), 1e-5);
  TriangleMesh scene = fine;  // beside a far triangle: now the sphere's edges are as short as what is joined
  scene.positions.conservativeResize(fine.vertex_count() + 3, 3);
  scene.positions.bottomRows(3) << 1000, 0, 0, 1001, 0, 0, 1000, 1, 0;
  scene.triangles.conservativeResize(fine.triangle_count() + 1, 3);
  scene.triangles.bottomRows(1) << fine.vertex_count(), fine.vertex_count() + 1, fine.vertex_count() + 2;
  const PreparedMesh prepared = prepare(scene, {.analysed = AnalysedSurface::as_it_is});
  CHECK(prepared.surface.triangle_count() == scene.triangle_count());  // no triangle shrank to a line
  CHECK(prepared.components == 2);
}

TEST_CASE("a closed surface, and one whose borders meet nothing, are as they were") {
  for (const TriangleMesh& mesh : {sphere(4), halves(sphere(4), 0.1)}) {
    CHECK(stitched_borders(mesh, edge_sides(mesh)).empty());
    CHECK(prepare(mesh).surface.positions == prepare(mesh, {.repair_orientation = false}).surface.positions);
  }
}

TEST_CASE("without welding nothing is joined, and invalid corners take no part") {
  TriangleMesh mesh = halves(sphere(4), 1e-6);
  CHECK(prepare(mesh, {.weld = false}).components == 2);
  mesh.positions(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK(prepare(mesh, {.lenient = true}).surface_vertex[0] == -1);
  mesh.positions *= 1e300;  // the square of its size overflows
  CHECK(prepare(mesh, {.lenient = true}).components == 2);
}
