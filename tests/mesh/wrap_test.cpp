// Whatever goes in, one closed manifold comes out; and where there is a truth to compare with, it is the shape that the triangles show
// from outside.
#include "mesh/wrap.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "mesh/closest_point.h"
#include "mesh/components.h"
#include "mesh/solid_grid.h"
#include "mesh/topology.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

constexpr double ball_volume = 4 * std::numbers::pi / 3;  // of radius 1

TriangleMesh both(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh result;
  result.positions.resize(a.vertex_count() + b.vertex_count(), 3);
  result.positions << a.positions, b.positions;
  result.triangles.resize(a.triangle_count() + b.triangle_count(), 3);
  result.triangles << a.triangles, (b.triangles.array() + a.vertex_count()).matrix();
  return result;
}

TriangleMesh ball(double radius, const Vector3& centre, int levels = 4) {
  TriangleMesh mesh = sphere(levels);
  mesh.positions = ((radius * mesh.positions).rowwise() + centre.transpose()).eval();
  return mesh;
}

TriangleMesh turned_over(TriangleMesh mesh) {
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) turn_over(mesh, t);
  return mesh;
}

// Every triangle has corners of its own.
TriangleMesh torn(const TriangleMesh& mesh) {
  TriangleMesh result;
  result.positions.resize(3 * mesh.triangle_count(), 3);
  result.triangles.resize(mesh.triangle_count(), 3);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) {
      result.triangles(t, i) = 3 * t + i;
      result.positions.row(3 * t + i) = mesh.positions.row(mesh.triangles(t, i));
    }
  return result;
}

// The same surface: each triangle cut into three.
TriangleMesh cut_up(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  const int32_t n = mesh.vertex_count(), m = mesh.triangle_count();
  result.positions.conservativeResize(n + m, 3);
  result.triangles.resize(3 * m, 3);
  for (int32_t t = 0; t < m; ++t) {
    result.positions.row(n + t) = position_of(mesh, {t, Vector3(0.5, 0.3, 0.2)});
    for (int i = 0; i < 3; ++i)
      result.triangles.row(3 * t + i) << mesh.triangles(t, i), mesh.triangles(t, (i + 1) % 3), n + t;
  }
  return result;
}

// The cube [-1, 1]^3 of 12 triangles.
TriangleMesh cube() {
  TriangleMesh mesh;
  mesh.positions.resize(8, 3);
  for (int v = 0; v < 8; ++v)
    mesh.positions.row(v) << 2 * (v & 1) - 1, 2 * ((v >> 1) & 1) - 1, 2 * (v >> 2) - 1;
  mesh.triangles.resize(12, 3);
  mesh.triangles << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2,
      1, 3, 7, 1, 7, 5;
  return mesh;
}

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto corner = [&](int i) -> Vector3 { return mesh.positions.row(mesh.triangles(t, i)); };
    sum += corner(0).dot(corner(1).cross(corner(2))) / 6;
  }
  return sum;
}

// Closed, each edge run along once in either way, no vertex where parts touch, nothing inside out.
bool is_sound(const TriangleMesh& mesh) {
  const EdgeSides edges = edge_sides(mesh);
  const Topology topology = topology_of(mesh, edges);
  std::set<std::pair<int32_t, int32_t>> ways;
  for (int32_t s = 0; s < 3 * mesh.triangle_count(); ++s)
    if (!ways.emplace(side_from(mesh.triangles, s), side_to(mesh.triangles, s)).second) return false;
  return mesh.positions.allFinite() && topology.nonmanifold_edges == 0 &&
         topology.nonmanifold_vertices == 0 && topology.boundary_loops == 0 &&
         components_of(mesh).count == 1 && volume(mesh) > 0;
}

int32_t euler(const TriangleMesh& mesh) {
  return mesh.vertex_count() - edge_sides(mesh).edge_count() + mesh.triangle_count();
}

TriangleMesh sound_wrap(const TriangleMesh& mesh, const WrapParams& params = {}) {
  TriangleMesh result = wrap(mesh, params, {}).mesh;
  CHECK(is_sound(result));
  return result;
}

// How far the vertices of a surface lie from another one: the mean and the most.
std::pair<double, double> distances(const TriangleMesh& from, const TriangleMesh& to) {
  std::vector<SurfaceQuery> queries;
  for (int32_t v = 0; v < from.vertex_count(); ++v)
    queries.push_back({from.positions.row(v), Vector3::Zero()});
  const auto nearest = closest_points(to, queries, mean_edge_length(to));
  double sum = 0, most = 0;
  for (size_t i = 0; i < nearest.size(); ++i) {
    const double distance = (position_of(to, nearest[i]) - queries[i].position).norm();
    sum += distance, most = std::max(most, distance);
  }
  return {sum / static_cast<double>(nearest.size()), most};
}

}  // namespace

TEST_CASE("wrap: a sphere stays a sphere") {
  const WrappedMesh wrapped = wrap(sphere(5), {}, {});
  CHECK(is_sound(wrapped.mesh));
  CHECK(euler(wrapped.mesh) == 2);
  CHECK(volume(wrapped.mesh) == doctest::Approx(ball_volume).epsilon(0.005));
  CHECK(wrapped.bridged == 0);
  CHECK(wrapped.left_out == 0);
  const Vector off = (wrapped.mesh.positions.rowwise().norm().array() - 1).abs();
  CHECK(off.mean() < 0.04 * wrapped.cell);
  CHECK(off.maxCoeff() < 0.25 * wrapped.cell);
}

TEST_CASE("wrap: spheres that meet become the surface round both") {
  const TriangleMesh wrapped = sound_wrap(both(sphere(5), ball(1, {1, 0, 0}, 5)));
  CHECK(euler(wrapped) == 2);
  CHECK(volume(wrapped) == doctest::Approx(2 * ball_volume - 5 * std::numbers::pi / 12).epsilon(0.005));
}

TEST_CASE("wrap: what lies inside disappears, whichever way it faces") {
  const TriangleMesh inner = ball(0.5, {0.1, 0.2, 0});
  for (const TriangleMesh& mesh : {both(sphere(5), inner), both(sphere(5), turned_over(inner))}) {
    const TriangleMesh wrapped = sound_wrap(mesh);
    CHECK(euler(wrapped) == 2);
    CHECK(volume(wrapped) == doctest::Approx(ball_volume).epsilon(0.005));
    CHECK(wrapped.positions.rowwise().norm().minCoeff() > 0.98);
  }
}

TEST_CASE("wrap: doubled, flipped and inverted faces do not matter") {
  const TriangleMesh whole = sphere(5);
  TriangleMesh some = whole;
  Random random(4);
  for (int32_t t = 0; t < some.triangle_count(); ++t)
    if (random.below(10) == 0) turn_over(some, t);
  for (const TriangleMesh& mesh :
       {both(whole, whole), both(whole, turned_over(whole)), turned_over(whole), some}) {
    const TriangleMesh wrapped = sound_wrap(mesh);
    CHECK(euler(wrapped) == 2);
    CHECK(volume(wrapped) == doctest::Approx(ball_volume).epsilon(0.005));
  }
}

TEST_CASE("wrap: a cube is a cube, with one side open too") {
  TriangleMesh open = cube();
  for (const int32_t first : {0, 6, 10}) {
    TriangleMesh mesh = cube();
    mesh.triangles.middleRows(first, 12 - first - 2) = mesh.triangles.bottomRows(12 - first - 2).eval();
    mesh.triangles.conservativeResize(10, 3);
    const WrappedMesh wrapped = wrap(mesh, {}, {});
    CHECK(is_sound(wrapped.mesh));
    CHECK(euler(wrapped.mesh) == 2);
    CHECK(volume(wrapped.mesh) == doctest::Approx(8).epsilon(0.02));
    CHECK(wrapped.mesh.positions.cwiseAbs().maxCoeff() < 1 + 2 * wrapped.cell);
  }
  CHECK(volume(sound_wrap(open)) == doctest::Approx(8).epsilon(0.005));
}

TEST_CASE("wrap: a thin open sheet becomes about a cell thick") {
  for (const bool turned : {false, true}) {
    TriangleMesh sheet = square(10);
    Random random(6);
    if (turned) sheet.positions = (sheet.positions * random_rotation(random)).eval();
    const WrappedMesh wrapped = wrap(sheet, {}, {});
    CHECK(is_sound(wrapped.mesh));
    CHECK(euler(wrapped.mesh) == 2);
    CHECK(distances(wrapped.mesh, sheet).second < 1.5 * wrapped.cell);
    CHECK(distances(sheet, wrapped.mesh).second < 1.5 * wrapped.cell);
    CHECK(volume(wrapped.mesh) / (4 * wrapped.cell) == doctest::Approx(1).epsilon(0.5));
  }
}

TEST_CASE("wrap: cracks between split vertices close") {
  TriangleMesh mesh = torn(with_radius(sphere(5), lump));
  const double truth = volume(mesh), size = mesh.positions.cwiseAbs().maxCoeff();
  Random random(7);
  for (double& x : mesh.positions.reshaped()) x += 1e-6 * size * random.normal();
  const TriangleMesh wrapped = sound_wrap(mesh);
  CHECK(euler(wrapped) == 2);
  CHECK(volume(wrapped) == doctest::Approx(truth).epsilon(0.005));
}

TEST_CASE("wrap: any soup of triangles gives one closed manifold") {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const auto triangles = static_cast<int32_t>(4 + random.below(60));
    const double size = seed % 3 == 0 ? 1 : 0.2, flatness = seed % 5 == 0 ? 0 : 1;
    TriangleMesh mesh;
    mesh.positions.resize(3 * triangles, 3);
    mesh.triangles.resize(triangles, 3);
    for (int32_t t = 0; t < triangles; ++t) {
      const Vector3 centre(random.normal(), random.normal(), flatness * random.normal());
      for (int i = 0; i < 3; ++i) {
        mesh.triangles(t, i) = 3 * t + i;
        mesh.positions.row(3 * t + i) =
            centre + size * Vector3(random.normal(), random.normal(), flatness * random.normal());
      }
    }
    const TriangleMesh wrapped = sound_wrap(mesh, {.cells = 40});
    CHECK(euler(wrapped) <= 2);
    CHECK(euler(wrapped) % 2 == 0);
  }
}

TEST_CASE("wrap: moving the mesh hardly moves the surface") {
  const TriangleMesh mesh = both(with_radius(sphere(5), lump), ball(0.4, {0, 1.5, 0.3}));
  const WrappedMesh before = wrap(mesh, {}, {});
  Random random(9);
  const Matrix3 turn = random_rotation(random);
  TriangleMesh moved = mesh;
  moved.positions =
      ((3 * mesh.positions * turn.transpose()).rowwise() + Eigen::RowVector3d(7, -2, 0.4)).eval();
  TriangleMesh after = sound_wrap(moved);
  after.positions = ((after.positions.rowwise() - Eigen::RowVector3d(7, -2, 0.4)) * turn / 3).eval();
  for (const auto& [mean, most] : {distances(before.mesh, after), distances(after, before.mesh)}) {
    CHECK(mean < 0.05 * before.cell);
    CHECK(most < 1.5 * before.cell);
  }
}

TEST_CASE("wrap: the order of triangles does not matter, how they are cut and rounded hardly") {
  TriangleMesh slender = with_radius(sphere(4), lump);  // its longest side decides on the cell
  slender.positions = (slender.positions * Vector3(0.5, 5, 0.6).asDiagonal()).eval();
  for (const TriangleMesh& mesh : {with_radius(sphere(4), lump), slender}) {
    const WrappedMesh first = wrap(mesh, {}, {});
    TriangleMesh shuffled = torn(mesh);
    shuffled.triangles = shuffled.triangles.colwise().reverse().eval();
    const TriangleMesh again = sound_wrap(shuffled);
    REQUIRE(again.vertex_count() == first.mesh.vertex_count());
    CHECK(again.triangles == first.mesh.triangles);
    CHECK((again.positions - first.mesh.positions).cwiseAbs().maxCoeff() < 1e-9);
    // The lattice stays; only a cell whose centre lies on the surface may change sides.
    std::vector<TriangleMesh> alike = {cut_up(mesh)};
    for (uint64_t seed = 0; seed < 4; ++seed) {
      alike.push_back(mesh);
      Random random(seed);
      for (double& x : alike.back().positions.reshaped()) x *= 1 + 1e-14 * random.normal();
    }
    for (const TriangleMesh& other : alike) {
      const TriangleMesh wrapped = sound_wrap(other);
      for (const auto& [mean, most] : {distances(first.mesh, wrapped), distances(wrapped, first.mesh)}) {
        CHECK(mean < 0.002 * first.cell);
        CHECK(most < first.cell);
      }
    }
  }
}

TEST_CASE("wrap: parts near each other become one, small ones far away are left out") {
  const WrappedMesh joined = wrap(both(sphere(4), ball(1, {2.2, 0, 0})), {}, {});
  CHECK(is_sound(joined.mesh));
  CHECK(euler(joined.mesh) == 2);
  CHECK(joined.bridged == 1);
  CHECK(joined.left_out == 0);
  CHECK(volume(joined.mesh) == doctest::Approx(2 * ball_volume).epsilon(0.01));
  const WrappedMesh apart = wrap(both(sphere(4), ball(0.1, {3, 0, 0})), {}, {});
  CHECK(is_sound(apart.mesh));
  CHECK(apart.bridged == 0);
  CHECK(apart.left_out == 1);
  CHECK(apart.mesh.positions.col(0).maxCoeff() < 1.1);
  const WrappedMesh far =
      wrap(both(sphere(4), ball(0.9, {6, 0, 0})), {}, {});  // as large as the other: it counts
  CHECK(is_sound(far.mesh));
  CHECK(far.bridged == 1);
  CHECK(far.mesh.positions.col(0).maxCoeff() > 6.8);
}

TEST_CASE("wrap: the same bits for any number of threads") {
  const TriangleMesh mesh = both(with_radius(sphere(4), lump), square(5));
  Execution four;
  four.thread_count = 4;
  const TriangleMesh a = wrap(mesh, {}, {}).mesh, b = wrap(mesh, {}, four).mesh;
  CHECK(a.positions == b.positions);
  CHECK(a.triangles == b.triangles);
}
