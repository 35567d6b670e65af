// Distances and regions on a sphere, where the truth is known.
#include "landmarks/regions.h"

#include <doctest/doctest.h>

#include <cmath>

#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

Proxy proxy_of(TriangleMesh mesh, int32_t vertices, const PrepareParams& how = {}) {
  return make_proxy(std::make_shared<const PreparedMesh>(prepare(std::move(mesh), how)), vertices, {}, true);
}

void check_sphere(const Proxy& proxy, double radius) {
  const TriangleMesh& source = proxy.full->source;
  const SurfacePoint point{77, Vector3(0.5, 0.25, 0.25)};
  const Vector3 place = position_of(source, point).normalized();
  const auto distances = DistanceFields(proxy, {}).from(point, {});
  REQUIRE(static_cast<int32_t>(distances.size()) == source.vertex_count());
  // Within a triangle distances are mixed linearly; round the source, where they form a cone, that misses by half an edge.
  const TriangleMesh& coarse = proxy.coarse->surface;
  const auto half_edge = [&](const SurfacePoint& place) {
    double longest = 0;
    for (int i = 0; i < 3; ++i)
      longest = std::max(longest, (coarse.positions.row(coarse.triangles(place.triangle, i)) -
                                   coarse.positions.row(coarse.triangles(place.triangle, (i + 1) % 3)))
                                      .norm());
    return proxy.scale() * longest / 2;
  };
  const std::vector<SurfacePoint> full = {to_surface(*proxy.full, point)};
  const double at_source = half_edge(to_coarse(proxy, full)[0]);
  const auto places = coarse_place_of_vertices(proxy, {});
  for (int32_t v = 0; v < source.vertex_count(); ++v) {
    const double truth =
        radius *
        std::acos(std::clamp(place.dot(source.positions.row(v).normalized().transpose()), -1.0, 1.0));
    const double edge = std::max(at_source, half_edge(places[proxy.full->surface_vertex[v]]));
    CHECK(std::abs(distances[v] - truth) < edge + 0.02 * truth);
  }
}

}  // namespace

TEST_CASE("distances are geodesic and in the caller's units, with and without a proxy") {
  TriangleMesh mesh = sphere(5);
  mesh.positions *= 250;
  check_sphere(proxy_of(mesh, 0), 250);
  check_sphere(proxy_of(mesh, 1000), 250);
}

TEST_CASE("a hole that is small does not lengthen the way") {
  TriangleMesh mesh = sphere(5);
  std::vector<int32_t> kept;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    if (position_of(mesh, {t, Vector3::Constant(1.0 / 3)}).z() < 0.98) kept.push_back(t);
  mesh.triangles = MatrixX3i(mesh.triangles(kept, Eigen::all));
  const Proxy proxy = proxy_of(mesh, 0);
  CHECK(proxy.filled_holes == 1);
  const SurfacePoint point{0, Vector3(1, 0, 0)};
  const Vector3 place = position_of(mesh, point);
  const auto distances = DistanceFields(proxy, {}).from(point, {});
  int32_t unused = 0;
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (proxy.full->surface_vertex[v] < 0) {
      CHECK(std::isinf(distances[v]));
      ++unused;
    } else {
      CHECK(distances[v] ==
            doctest::Approx(std::acos(std::clamp(place.dot(mesh.positions.row(v).transpose()), -1.0, 1.0)))
                .epsilon(0.02)
                .scale(2));
    }
  }
  CHECK(unused > 10);
}

TEST_CASE("separate parts are reached, over bridges or along the surface round them all") {
  TriangleMesh two = sphere(3);
  const TriangleMesh one = two;
  two.positions.conservativeResize(2 * one.vertex_count(), 3);
  two.triangles.conservativeResize(2 * one.triangle_count(), 3);
  two.positions.bottomRows(one.vertex_count()) = one.positions.rowwise() + Eigen::RowVector3d(2.5, 0, 0);
  two.triangles.bottomRows(one.triangle_count()) = one.triangles.array() + one.vertex_count();
  const SurfacePoint point{0, Vector3(1, 0, 0)};
  const auto bridged =
      DistanceFields(proxy_of(two, 0, {.analysed = AnalysedSurface::as_it_is}), {}).from(point, {});
  const auto wrapped = DistanceFields(proxy_of(two, 0), {}).from(point, {});
  for (int32_t v = 0; v < two.vertex_count(); ++v) {
    CHECK(std::isfinite(bridged[v]));
    // Straight is shortest; and nothing is farther than half round either and across.
    CHECK(wrapped[v] > 0.95 * (two.positions.row(v) - two.positions.row(two.triangles(0, 0))).norm() - 0.1);
    CHECK(wrapped[v] < 2 * 3.1416 + 1.5);
  }
}

TEST_CASE("a region is 1 inside, 0 outside, and has the area of its cap") {
  const TriangleMesh mesh = sphere(5);
  const double radius = 0.8, border = mean_edge_length(mesh);
  const auto distances = DistanceFields(proxy_of(mesh, 1000), {}).from({5, Vector3::Constant(1.0 / 3)}, {});
  const auto share = membership(distances, radius, border);
  double area = 0;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto at = [&](int i) -> Vector3 { return mesh.positions.row(mesh.triangles(t, i)); };
    for (int i = 0; i < 3; ++i)
      area += share[mesh.triangles(t, i)] * (at(1) - at(0)).cross(at(2) - at(0)).norm() / 6;
  }
  CHECK(area == doctest::Approx(2 * 3.14159 * (1 - std::cos(radius))).epsilon(0.03));
  for (size_t v = 0; v < share.size(); ++v) {
    if (distances[v] < radius - border) CHECK(share[v] == 1);
    if (distances[v] > radius + border) CHECK(share[v] == 0);
  }
  CHECK(membership({1, std::numeric_limits<float>::infinity()}, 1, 0.1) == std::vector<float>{0.5F, 0});
}
