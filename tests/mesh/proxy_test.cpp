// A proxy looks like the surface it stands for, and points go over and back.
#include "mesh/proxy.h"

#include <doctest/doctest.h>

#include <cmath>

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
  const auto places = coarse_place_of_vertices(proxy);
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
