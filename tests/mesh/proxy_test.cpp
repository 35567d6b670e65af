// A proxy looks like the surface it stands for, and points go over and back.
#include "mesh/proxy.h"

#include <doctest/doctest.h>

#include <cmath>

#include "mesh/components.h"
#include "mesh/fill_holes.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

std::shared_ptr<const PreparedMesh> prepared(TriangleMesh mesh) {
  return std::make_shared<const PreparedMesh>(prepare(std::move(mesh)));
}

}  // namespace

TEST_CASE("a small surface is its own proxy") {
  const auto mesh = prepared(sphere(3));
  CHECK(make_proxy(mesh, 0).is_full());
  CHECK(make_proxy(mesh, 2000).is_full());
  CHECK(make_proxy(mesh, 0).scale() == mesh->scale);
}

TEST_CASE("a proxy has about the vertices asked for, area 1, and its units lead back to the caller's") {
  TriangleMesh ellipsoid = sphere(5);
  ellipsoid.positions = ellipsoid.positions * Vector3(3, 1, 2).asDiagonal();
  const double area = surface_area(ellipsoid);
  const Proxy proxy = make_proxy(prepared(ellipsoid), 1000);
  CHECK(!proxy.is_full());
  CHECK(std::abs(proxy.coarse->surface.vertex_count() - 1000) < 60);
  CHECK(surface_area(proxy.coarse->surface) == doctest::Approx(1));
  CHECK(proxy.scale() == doctest::Approx(std::sqrt(area)).epsilon(0.01));
}

TEST_CASE("points go over to the proxy and back to nearly where they were") {
  const auto mesh = prepared(with_radius(sphere(5), [](const Vector3& p) { return 1 + 0.3 * p[0] * p[1]; }));
  const Proxy proxy = make_proxy(mesh, 1200);
  Random random(8);
  std::vector<SurfacePoint> points;
  for (int i = 0; i < 100; ++i)
    points.push_back(
        {static_cast<int32_t>(random.below(mesh->surface.triangle_count())), Vector3(0.2, 0.5, 0.3)});
  const auto there = to_coarse(proxy, points);
  const auto back = to_full(proxy, there);
  for (size_t i = 0; i < points.size(); ++i) {
    const double moved = (position_of(mesh->surface, points[i]) - position_of(mesh->surface, back[i])).norm();
    CHECK(moved < 0.2 * mean_edge_length(proxy.coarse->surface));
  }
  const auto places = coarse_place_of_vertices(proxy, {});
  REQUIRE(static_cast<int32_t>(places.size()) == mesh->surface.vertex_count());
  for (int32_t v = 0; v < mesh->surface.vertex_count(); ++v) {
    const Vector3 carried =
        proxy.coarse->centre + proxy.coarse->scale * position_of(proxy.coarse->surface, places[v]);
    CHECK((carried - mesh->surface.positions.row(v).transpose()).norm() < 0.02);
  }
}

TEST_CASE("the same proxy every time, still closed") {
  const auto mesh = prepared(sphere(5));
  const Proxy a = make_proxy(mesh, 700), b = make_proxy(mesh, 700);
  CHECK(a.coarse->surface.positions == b.coarse->surface.positions);
  CHECK(a.coarse->surface.triangles == b.coarse->surface.triangles);
  CHECK(a.coarse->surface.vertex_count() - a.coarse->surface.triangle_count() / 2 == 2);
}

TEST_CASE("a surface with holes is analysed closed, and nothing is found in a hole") {
  const auto lost = [](const Vector3& p) { return p.z() > 0.95 || (p.x() > 0.97 && p.y() > 0); };
  TriangleMesh holed = with_radius(sphere(5), [](const Vector3& p) { return 1 + 0.2 * p[0]; });
  std::vector<int32_t> kept;
  for (int32_t t = 0; t < holed.triangle_count(); ++t)
    if (!lost(position_of(holed, {t, Vector3::Constant(1.0 / 3)}).normalized())) kept.push_back(t);
  holed.triangles = MatrixX3i(holed.triangles(kept, Eigen::all));
  for (const int32_t vertices : {0, 1200}) {
    const Proxy open = make_proxy(prepared(holed), vertices),
                closed = make_proxy(prepared(holed), vertices, {}, true);
    CHECK(open.filled_holes == 0);
    CHECK(closed.filled_holes == 2);
    CHECK(!border_loops(open.coarse->surface).empty());
    CHECK(border_loops(closed.coarse->surface).empty());
    const TriangleMesh& coarse = closed.coarse->surface;
    std::vector<SurfacePoint> points;
    for (int32_t t = 0; t < coarse.triangle_count(); ++t) points.push_back({t, Vector3::Constant(1.0 / 3)});
    const auto full = to_full(closed, points);
    const double edge = mean_edge_length(closed.full->source);
    int moved = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      REQUIRE(full[i].triangle >= 0);  // a triangle of the caller's, always
      const Vector3 there = position_of(closed.full->source, to_source(*closed.full, full[i]));
      const Vector3 here =
          closed.full->centre + closed.full->scale * (closed.coarse->centre +
                                                      closed.coarse->scale * position_of(coarse, points[i]));
      const bool in_hole = lost(here.normalized());
      CHECK(((there - here).norm() < edge || in_hole));
      moved += in_hole && (there - here).norm() > 2 * edge;
    }
    CHECK(moved > 0);  // from the middles of the holes to their rims
  }
}

TEST_CASE("a closed surface has the same proxy whether holes are to be filled or not") {
  const auto mesh = prepared(with_radius(sphere(5), lump));
  const Proxy plain = make_proxy(mesh, 1000), filling = make_proxy(mesh, 1000, {}, true);
  CHECK(plain.coarse->surface.positions == filling.coarse->surface.positions);
  CHECK(plain.coarse->surface.triangles == filling.coarse->surface.triangles);
  CHECK(make_proxy(mesh, 0, {}, true).is_full());
}

TEST_CASE(
    "a mesh of several parts is analysed on one closed surface, and what is found there lies on its own "
    "triangles") {
  const TriangleMesh one = sphere(4);
  TriangleMesh three = one;  // the second meets the first, the third is apart from both
  for (const double x : {1.2, 3.4}) {
    const int32_t n = three.vertex_count(), m = three.triangle_count();
    three.positions.conservativeResize(n + one.vertex_count(), 3);
    three.triangles.conservativeResize(m + one.triangle_count(), 3);
    three.positions.bottomRows(one.vertex_count()) = one.positions.rowwise() + Eigen::RowVector3d(x, 0, 0);
    three.triangles.bottomRows(one.triangle_count()) = one.triangles.array() + n;
  }
  const auto mesh = prepared(three);
  REQUIRE(mesh->is_wrapped);
  for (const int32_t vertices : {0, 1500}) {
    const Proxy proxy = make_proxy(mesh, vertices, {}, true);
    const TriangleMesh& coarse = proxy.coarse->surface;
    CHECK_FALSE(proxy.is_full());
    CHECK(components_of(coarse).count == 1);
    CHECK(coarse.vertex_count() - coarse.triangle_count() / 2 == 2);
    if (vertices > 0) CHECK(std::abs(coarse.vertex_count() - vertices) < 0.1 * vertices);
    std::vector<SurfacePoint> points;
    for (int32_t t = 0; t < coarse.triangle_count(); t += 7)
      points.push_back({t, Vector3::Constant(1.0 / 3)});
    double most = 0;
    for (const SurfacePoint& point : to_full(proxy, points)) {
      REQUIRE(point.triangle >= 0);
      const Vector3 place = position_of(mesh->source, to_source(*mesh, point));
      for (const double x : {0.0, 1.2, 3.4})  // on the outside
        if (place.x() < 2.3 || x > 2) most = std::max(most, 1 - (place - Vector3(x, 0, 0)).norm());
    }
    CHECK(most < 0.1);
    const auto places = coarse_place_of_vertices(proxy, {});
    CHECK(static_cast<int32_t>(places.size()) == mesh->surface.vertex_count());
  }
  // Preset `paper` takes the triangles as they are, and its distances go over the bridges.
  CHECK(make_proxy(mesh, 0).is_full());
  CHECK_FALSE(bridges_of(*mesh).empty());
}
