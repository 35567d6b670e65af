// Exact distances where the true ones are known: unfolded polyhedra, the plane, the sphere, and bounds that hold anywhere.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

#include "base/error.h"
#include "geodesics/make_distance.h"
#include "mesh/components.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

RowMatrixf exact(const TriangleMesh& mesh, const std::vector<int32_t>& sources) {
  return distance_named("exact", mesh)->distances(sources, {});
}

TriangleMesh turned(TriangleMesh mesh, uint64_t seed) {
  Random random(seed);
  mesh.positions = (mesh.positions * random_rotation(random)).eval();
  return mesh;
}

// The unit cube's surface, n x n squares a face, cut into triangles along alternating diagonals; edges are welded.
TriangleMesh cube(int n) {
  std::map<std::array<int, 3>, int> vertex;
  std::vector<Vector3> points;
  std::vector<Eigen::Vector3i> faces;
  const auto at = [&](std::array<int, 3> p) {
    const auto [place, is_new] = vertex.try_emplace(p, static_cast<int>(points.size()));
    if (is_new) points.push_back(Vector3(p[0], p[1], p[2]) / n);
    return place->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int u, int w) {
            std::array<int, 3> p{};
            p[axis] = side, p[(axis + 1) % 3] = i + u, p[(axis + 2) % 3] = j + w;
            return at(p);
          };
          int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side == 0) std::swap(b, d);
          if ((i + j) % 2)
            faces.insert(faces.end(), {{a, b, c}, {a, c, d}});
          else
            faces.insert(faces.end(), {{a, b, d}, {b, c, d}});
        }
  TriangleMesh mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(points.size()), 3);
  mesh.triangles.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (size_t i = 0; i < points.size(); ++i) mesh.positions.row(i) = points[i];
  for (size_t i = 0; i < faces.size(); ++i) mesh.triangles.row(i) = faces[i];
  return mesh;
}

int32_t vertex_at(const TriangleMesh& mesh, const Vector3& place) {
  Eigen::Index nearest = 0;
  REQUIRE((mesh.positions.rowwise() - place.transpose()).rowwise().norm().minCoeff(&nearest) < 1e-12);
  return static_cast<int32_t>(nearest);
}

// A cone of sides `sides` round a tip, as rings: its surface unfolds to a sector of the plane.
TriangleMesh cone(int sides, int rings, double height) {
  TriangleMesh mesh;
  mesh.positions.resize(1 + sides * rings, 3), mesh.triangles.resize(sides + 2 * sides * (rings - 1), 3);
  mesh.positions.row(0) << 0, 0, height;
  const auto at = [&](int ring, int side) { return 1 + (ring - 1) * sides + side % sides; };
  for (int ring = 1; ring <= rings; ++ring)
    for (int side = 0; side < sides; ++side) {
      const double share = static_cast<double>(ring) / rings, turn = 2 * std::numbers::pi * side / sides;
      mesh.positions.row(at(ring, side)) << share * std::cos(turn), share * std::sin(turn),
          height * (1 - share);
    }
  int t = 0;
  for (int side = 0; side < sides; ++side) {
    mesh.triangles.row(t++) << 0, at(1, side), at(1, side + 1);
    for (int ring = 1; ring < rings; ++ring) {
      mesh.triangles.row(t++) << at(ring, side), at(ring + 1, side), at(ring + 1, side + 1);
      mesh.triangles.row(t++) << at(ring, side), at(ring + 1, side + 1), at(ring, side + 1);
    }
  }
  return mesh;
}

// Along edges only: never shorter than the true distance.
std::vector<double> along_edges(const TriangleMesh& mesh, int32_t source) {
  std::vector<std::vector<int32_t>> near(mesh.vertex_count());
  const auto edges = edges_of(mesh);
  for (Eigen::Index e = 0; e < edges.rows(); ++e)
    near[edges(e, 0)].push_back(edges(e, 1)), near[edges(e, 1)].push_back(edges(e, 0));
  std::vector<double> distance(mesh.vertex_count(), 1e300);
  std::priority_queue<std::pair<double, int32_t>> queue;
  queue.emplace(0, source), distance[source] = 0;
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    for (const int32_t w : near[v]) {
      const double next = distance[v] + (mesh.positions.row(v) - mesh.positions.row(w)).norm();
      if (next < distance[w]) queue.emplace(-next, w), distance[w] = next;
    }
  }
  return distance;
}

TriangleMesh bumpy(int levels, uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh = with_radius(turned(sphere(levels), seed), lump);
  for (Eigen::Index i = 0; i < mesh.positions.size(); ++i) mesh.positions.data()[i] += 0.03 * random.normal();
  return mesh;
}

}  // namespace

TEST_CASE("exact: on the plane distances are those of Euclid, however the triangles lie") {
  for (const double jitter : {0.0, 0.25}) {  // more would fold the plane
    const TriangleMesh mesh = turned(square(12, jitter, 5), 3);
    for (const int32_t source : {0, 7, 312, 333}) {
      const RowMatrixf d = exact(mesh, {source});
      for (int32_t v = 0; v < mesh.vertex_count(); ++v)
        CHECK(d(0, v) ==
              doctest::Approx((mesh.positions.row(v) - mesh.positions.row(source)).norm()).epsilon(1e-6));
    }
  }
}

TEST_CASE("exact: from a point inside a triangle or on an edge too") {
  const TriangleMesh mesh = turned(square(6, 0.25, 2), 4);
  std::vector<SurfacePoint> points = {
      {5, {0.2, 0.3, 0.5}}, {20, {0.5, 0.5, 0}}, {60, {0, 1, 0}}, {7, {0, 0.25, 0.75}}};
  const RowMatrixf d = distance_named("exact", mesh)->distances(points, {});
  for (size_t s = 0; s < points.size(); ++s)
    for (int32_t v = 0; v < mesh.vertex_count(); ++v)
      CHECK(d(s, v) ==
            doctest::Approx((mesh.positions.row(v).transpose() - position_of(mesh, points[s])).norm())
                .epsilon(1e-6));
}

TEST_CASE("exact: over the edges and corners of a cube, by unfolding") {
  for (const int n : {1, 2, 5}) {
    const TriangleMesh mesh = cube(n);
    const RowMatrixf d = exact(mesh, {vertex_at(mesh, {0, 0, 0})});
    CHECK(d(0, vertex_at(mesh, {1, 1, 1})) == doctest::Approx(std::sqrt(5.0)).epsilon(1e-6));
    CHECK(d(0, vertex_at(mesh, {1, 1, 0})) == doctest::Approx(std::sqrt(2.0)).epsilon(1e-6));
    CHECK(d(0, vertex_at(mesh, {1, 0, 0})) == doctest::Approx(1.0).epsilon(1e-6));
    // Any point of the opposite faces: the shorter of the unfoldings over either of their edges.
    for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
      const Vector3 p = mesh.positions.row(v);
      double truth = p.minCoeff() < 1e-9 ? p.norm() : 1e300;
      for (int i = 0; i < 3; ++i) {
        const double y = p[(i + 1) % 3], z = p[(i + 2) % 3];
        if (p[i] > 1 - 1e-9) truth = std::min({truth, std::hypot(1 + y, z), std::hypot(1 + z, y)});
      }
      CHECK(d(0, v) == doctest::Approx(truth).epsilon(1e-6));
    }
  }
}

TEST_CASE("exact: round a cone by its unfolded sector") {
  for (const double height : {0.4, 2.5}) {
    const int sides = 24, rings = 6;
    const TriangleMesh mesh = cone(sides, rings, height);
    const double slant = std::hypot(1, height);
    const double side = 2 * std::asin(std::sin(std::numbers::pi / sides) / slant);  // at the tip, unfolded
    const RowMatrixf d = exact(mesh, {1 + (rings - 1) * sides});                    // from the rim
    CHECK(d(0, 0) == doctest::Approx(slant).epsilon(1e-6));
    for (int ring = 1; ring <= rings; ++ring)
      for (int s = 0; s <= sides / 2; ++s) {
        const double r = slant * ring / rings, angle = s * side;
        const double truth = std::hypot(r * std::cos(angle) - slant, r * std::sin(angle));
        CHECK(d(0, 1 + (ring - 1) * sides + s) == doctest::Approx(truth).epsilon(1e-6));
      }
  }
}

TEST_CASE("exact: on finer and finer spheres distances become arcs, with an error of second order") {
  double before = 0;
  for (const int levels : {2, 3, 4}) {
    const TriangleMesh mesh = turned(sphere(levels), 8);
    const RowMatrixf d = exact(mesh, {0});
    double error = 0;
    for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
      const double arc = std::acos(std::clamp(mesh.positions.row(v).dot(mesh.positions.row(0)), -1.0, 1.0));
      error += std::abs(d(0, v) - arc) / mesh.vertex_count();
    }
    if (before > 0) CHECK(error < before / 3);
    before = error;
  }
  CHECK(before < 0.005);
}

TEST_CASE(
    "exact: symmetric, a metric, between space and edges, and shorter than the heat method's on bumps") {
  for (const uint64_t seed : {1, 2, 3}) {
    const TriangleMesh mesh = bumpy(3, seed);
    std::vector<int32_t> all(mesh.vertex_count());
    for (int32_t v = 0; v < mesh.vertex_count(); ++v) all[v] = v;
    const RowMatrixf d = exact(mesh, all);
    CHECK((d - d.transpose()).cwiseAbs().maxCoeff() < 1e-5);
    double broken = 0;
    for (const int32_t via : {3, 50, 200})
      for (int32_t a = 0; a < mesh.vertex_count(); a += 3)
        for (int32_t b = 0; b < mesh.vertex_count(); b += 3)
          broken = std::max<double>(broken, d(a, b) - d(a, via) - d(via, b));
    CHECK(broken < 1e-5);
    for (const int32_t s : {0, 17, 111}) {
      const auto edges = along_edges(mesh, s);
      for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
        CHECK(d(s, v) <= edges[v] * (1 + 1e-6));
        CHECK(d(s, v) >= (mesh.positions.row(s) - mesh.positions.row(v)).norm() * (1 - 1e-6));
      }
    }
  }
}

TEST_CASE("exact: a mesh cut finer, by the middles of its edges, has the same distances") {
  const TriangleMesh mesh = bumpy(2, 7);
  TriangleMesh finer;  // each triangle into four, the surface as it is
  const auto edges = edges_of(mesh);
  const auto n = mesh.vertex_count();
  finer.positions.resize(n + edges.rows(), 3);
  finer.positions.topRows(n) = mesh.positions;
  std::map<std::pair<int32_t, int32_t>, int32_t> middle;
  for (Eigen::Index e = 0; e < edges.rows(); ++e) {
    middle[{edges(e, 0), edges(e, 1)}] = middle[{edges(e, 1), edges(e, 0)}] = n + static_cast<int32_t>(e);
    finer.positions.row(n + e) = (mesh.positions.row(edges(e, 0)) + mesh.positions.row(edges(e, 1))) / 2;
  }
  finer.triangles.resize(4 * mesh.triangle_count(), 3);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const int32_t a = mesh.triangles(t, 0), b = mesh.triangles(t, 1), c = mesh.triangles(t, 2);
    const int32_t ab = middle[{a, b}], bc = middle[{b, c}], ca = middle[{c, a}];
    finer.triangles.middleRows(4 * t, 4) << a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca;
  }
  for (const int32_t source : {0, 9, 40}) {
    const RowMatrixf coarse = exact(mesh, {source}), fine = exact(finer, {source});
    CHECK((coarse - fine.leftCols(n)).cwiseAbs().maxCoeff() < 1e-5);
  }
}

TEST_CASE("exact: parts are reached over their bridges, and without any lie as far as anything can") {
  TriangleMesh mesh = square(3);
  const TriangleMesh other = square(3);
  const int32_t n = mesh.vertex_count(), m = mesh.triangle_count();
  mesh.positions.conservativeResize(2 * n, 3), mesh.triangles.conservativeResize(2 * m, 3);
  mesh.positions.bottomRows(n) = other.positions.rowwise() + Eigen::RowVector3d(0, 0, 1);
  mesh.triangles.bottomRows(m) = other.triangles.array() + n;
  const std::vector<std::pair<int32_t, int32_t>> bridges = {{0, n}};
  const std::vector<int32_t> source = {n / 2};
  const RowMatrixf over = distance_named("exact", mesh, bridges)->distances(source, {});
  CHECK(over(0, 2 * n - 1) == doctest::Approx(std::sqrt(2.0) + 1 + 2 * std::sqrt(2.0)).epsilon(1e-6));
  const auto apart = distance_named("exact", mesh);
  CHECK(apart->distances(source, {})(0, 2 * n - 1) == doctest::Approx(apart->distance_bound()));
}

TEST_CASE("exact: slivers, folded edges and edges of three triangles give finite distances") {
  TriangleMesh mesh = bumpy(2, 4);
  mesh.positions.row(5) = mesh.positions.row(mesh.triangles(0, 1));  // triangles without area
  const int32_t m = mesh.triangle_count();
  mesh.triangles.conservativeResize(m + 1, 3);
  mesh.triangles.row(m) << mesh.triangles(3, 0), mesh.triangles(3, 1), 20;  // a fin
  const RowMatrixf d = exact(mesh, {0, 5, 20});
  CHECK(d.allFinite());
  for (int s = 0; s < 3; ++s) {
    const int32_t source = s == 0 ? 0 : s == 1 ? 5 : 20;
    const auto edges = along_edges(mesh, source);
    for (int32_t v = 0; v < mesh.vertex_count(); ++v) CHECK(d(s, v) <= edges[v] * (1 + 1e-6) + 1e-9);
  }
}

TEST_CASE("exact: the same bits for any number of threads, and it can be cancelled") {
  const TriangleMesh mesh = bumpy(3, 9);
  std::vector<int32_t> sources;
  for (int32_t v = 0; v < 100; ++v) sources.push_back(v);
  const auto distance = distance_named("exact", mesh);
  Execution one, three;
  one.thread_count = 1, three.thread_count = 3;
  CHECK(distance->distances(sources, one) == distance->distances(sources, three));
  Task task;
  task.cancel();
  one.task = &task;
  CHECK_THROWS_AS(distance->distances(sources, one), Error);
}
