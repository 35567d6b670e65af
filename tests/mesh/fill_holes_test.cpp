// Filled holes give back the surface that was there, and leave everything else alone.
#include "mesh/fill_holes.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "kit/corruption.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

using std::numbers::pi;

double volume(const TriangleMesh& mesh) {
  double six = 0;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto corner = [&](int i) -> Vector3 { return mesh.positions.row(mesh.triangles(t, i)); };
    six += corner(0).dot(corner(1).cross(corner(2)));
  }
  return six / 6;
}

int max_triangles_on_an_edge(const TriangleMesh& mesh) {
  std::map<std::pair<int32_t, int32_t>, int> uses;
  int most = 0;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i)
      most = std::max(most, ++uses[std::minmax({mesh.triangles(t, i), mesh.triangles(t, (i + 1) % 3)})]);
  return most;
}

bool begins_with(const TriangleMesh& filled, const TriangleMesh& mesh) {
  return filled.positions.topRows(mesh.vertex_count()) == mesh.positions &&
         filled.triangles.topRows(mesh.triangle_count()) == mesh.triangles;
}

TriangleMesh with_these_holes(const TriangleMesh& mesh, int32_t count, double radius, uint64_t seed) {
  Random random(seed);
  return with_holes(intact(mesh), count, radius, random).mesh;
}

// Without the triangles for which lost(centroid).
template <class Lost>
TriangleMesh without(const TriangleMesh& mesh, Lost lost) {
  std::vector<char> stays;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    stays.push_back(!lost(position_of(mesh, {t, Vector3::Constant(1.0 / 3)})));
  return keep_triangles(intact(mesh), stays).mesh;
}

TriangleMesh of(std::initializer_list<Vector3> positions, std::initializer_list<Eigen::Vector3i> triangles) {
  TriangleMesh mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(positions.size()), 3);
  mesh.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  Eigen::Index row = 0;
  for (const auto& p : positions) mesh.positions.row(row++) = p;
  row = 0;
  for (const auto& t : triangles) mesh.triangles.row(row++) = t;
  return mesh;
}

}  // namespace

TEST_CASE("a closed mesh has nothing to fill") {
  const TriangleMesh mesh = with_radius(sphere(4), lump);
  CHECK(border_loops(mesh).empty());
  CHECK(fill_holes(mesh, {.longest_border = 1e9, .largest_share = 1e9}).holes == 0);
}

TEST_CASE("a missing triangle is put back, turned as it was") {
  TriangleMesh mesh = sphere(3);
  const Eigen::RowVector3i last = mesh.triangles.bottomRows(1);
  mesh.triangles.conservativeResize(mesh.triangle_count() - 1, 3);
  const FilledMesh filled = fill_holes(mesh);
  REQUIRE(filled.mesh.triangle_count() == mesh.triangle_count() + 1);
  CHECK(begins_with(filled.mesh, mesh));
  CHECK(is_closed(filled.mesh));
  std::set<int32_t> was(last.begin(), last.end());
  for (int i = 0; i < 3; ++i) CHECK(was.contains(filled.mesh.triangles(mesh.triangle_count(), i)));
}

TEST_CASE("spheres with small and wide holes get their area and volume back") {
  const TriangleMesh whole = sphere(5);
  const double area = surface_area(whole), inside = volume(whole);
  struct Holes {
    int32_t count;
    double radius, tolerance;
  };
  for (const Holes& holes :
       {Holes{60, 0, 0.002}, Holes{20, 1.5, 0.002}, Holes{25, 2.5, 0.004}, Holes{3, 8, 0.004}}) {
    CAPTURE(holes.radius);
    const double tolerance = holes.tolerance;
    const TriangleMesh holed = with_these_holes(whole, holes.count, holes.radius, 3);
    const FilledMesh filled = fill_holes(holed, {.longest_border = 2});
    CHECK(filled.holes == static_cast<int32_t>(border_loops(holed).size()));
    CHECK(begins_with(filled.mesh, holed));
    CHECK(is_closed(filled.mesh));
    CHECK(surface_area(filled.mesh) == doctest::Approx(area).epsilon(tolerance));
    CHECK(volume(filled.mesh) == doctest::Approx(inside).epsilon(tolerance));
    CHECK(surface_area(holed) < area * (1 - tolerance));  // so there was something to win
    for (int32_t v = holed.vertex_count(); v < filled.mesh.vertex_count(); ++v)
      CHECK(filled.mesh.positions.row(v).norm() == doctest::Approx(1).epsilon(0.03));
  }
}

TEST_CASE("a stump ends flat, a hole in a curved surface bulges with it") {
  TriangleMesh capsule = sphere(5);  // a long limb along z
  for (Eigen::Index v = 0; v < capsule.positions.rows(); ++v) capsule.positions(v, 2) *= 4;
  const TriangleMesh stump =
      cut_beyond(intact(capsule), Vector3(0, 0, 1), Vector3(0, 0, 1), CutEnd::open).mesh;
  const FilledMesh flat = fill_holes(stump, {.longest_border = 3, .largest_share = 0.3});
  REQUIRE(flat.holes == 1);
  CHECK(flat.mesh.positions.col(2).maxCoeff() <= 1);
  const TriangleMesh bald =
      cut_beyond(intact(sphere(5)), Vector3(0, 0, 0.9), Vector3(0, 0, 1), CutEnd::open).mesh;
  const FilledMesh round = fill_holes(bald, {.longest_border = 3});
  REQUIRE(round.holes == 1);
  CHECK(bald.positions.col(2).maxCoeff() <= 0.9);
  CHECK(round.mesh.positions.col(2).maxCoeff() > 0.95);  // more than half of what was cut off
  CHECK(round.mesh.positions.col(2).maxCoeff() < 1.01);
}

TEST_CASE("patches are about as dense as what is around them") {
  const TriangleMesh whole = sphere(5), holed = with_these_holes(whole, 1, 8, 1);
  const FilledMesh filled = fill_holes(holed, {.longest_border = 2});
  const int32_t lost = whole.vertex_count() - holed.vertex_count();
  const int32_t made = filled.mesh.vertex_count() - holed.vertex_count();
  CHECK(made > 0.5 * lost);
  CHECK(made < 1.6 * lost);
}

TEST_CASE("random holes of bumpy shapes close, whatever the holes do to each other") {
  const TriangleMesh mesh = with_radius(sphere(4), lump);
  for (uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    Random random(seed, 5);
    const auto count = static_cast<int32_t>(1 + random.below(60));
    const TriangleMesh holed = with_these_holes(mesh, count, 3 * random.uniform(), seed);
    const FilledMesh filled = fill_holes(holed, {.longest_border = 0.6});
    if (filled.holes == 0) continue;
    CHECK(begins_with(filled.mesh, holed));
    CHECK(filled.mesh.positions.allFinite());
    CHECK(filled.mesh.triangles.maxCoeff() < filled.mesh.vertex_count());
    CHECK(max_triangles_on_an_edge(filled.mesh) == 2);
    CHECK(border_loops(filled.mesh).size() == border_loops(holed).size() - filled.holes);
  }
}

TEST_CASE("holes that touch at a vertex come apart there and are both closed") {
  const TriangleMesh flat = square(6);
  // Two squares of four triangles each, corner to corner in the middle.
  const TriangleMesh holed = without(flat, [](const Vector3& p) {
    return (p.x() > 0 && p.x() < 0.3 && p.y() > 0 && p.y() < 0.3) ||
           (p.x() < 0 && p.x() > -0.3 && p.y() < 0 && p.y() > -0.3);
  });
  const auto loops = border_loops(holed);
  REQUIRE(loops.size() == 3);  // with the rim of the sheet
  for (const auto& loop : loops) CHECK(std::set(loop.begin(), loop.end()).size() == loop.size());
  const FilledMesh filled = fill_holes(holed);
  CHECK(filled.holes == 2);
  CHECK(surface_area(filled.mesh) == doctest::Approx(4).epsilon(1e-9));
  CHECK(border_loops(filled.mesh).size() == 1);
}

TEST_CASE("two holes with two corners in common do not both use the edge between them") {
  // A strip from a (0) to b (1), over 2 and 3, with a hole of four edges on each side; triangles round them.
  const std::initializer_list<Eigen::Vector3i> triangles = {{0, 2, 3}, {2, 1, 3}, {0, 6, 4},
                                                            {4, 7, 1}, {1, 8, 5}, {5, 9, 0}};
  Random random(3);
  int both = 0;
  for (int trial = 0; trial < 300; ++trial) {
    TriangleMesh mesh = of({{0, 0, 0}}, triangles);
    mesh.positions.resize(10, 3);
    for (Eigen::Index i = 0; i < mesh.positions.size(); ++i) mesh.positions.data()[i] = random.uniform();
    const FilledMesh filled = fill_holes(mesh, {.longest_border = 100, .largest_share = 100});
    REQUIRE(filled.holes > 0);
    CHECK(max_triangles_on_an_edge(filled.mesh) == 2);
    both += filled.holes > 1;
  }
  CHECK(both > 0);
}

TEST_CASE("long borders, open sheets and single triangles stay as they are") {
  const TriangleMesh sheet = square(5);
  CHECK(fill_holes(sheet, {.longest_border = 100}).holes == 0);
  CHECK(fill_holes(of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}), {.longest_border = 100}).holes == 0);
  const TriangleMesh bowl = without(sphere(4), [](const Vector3& p) { return p.z() > 0.5; });
  CHECK(fill_holes(bowl, {.longest_border = 1}).holes == 0);
  CHECK(fill_holes(bowl, {.longest_border = 2, .largest_share = 0.3}).holes == 1);
}

TEST_CASE("an island in a hole stays an island; the hole is closed beneath it") {
  const TriangleMesh holed = without(sphere(5), [](const Vector3& p) { return p.z() > 0.9 && p.z() < 0.97; });
  const FilledMesh filled = fill_holes(holed, {.longest_border = 2});
  CHECK(filled.holes == 1);
  CHECK(border_loops(filled.mesh).size() == 1);
}

TEST_CASE("a loop whose corners are joined elsewhere gets no edge twice") {
  // A pyramid without its base; then with a flap along each diagonal of the base.
  const TriangleMesh mesh = of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, -1}},
                               {{1, 0, 4}, {2, 1, 4}, {3, 2, 4}, {0, 3, 4}});
  FilledMesh filled = fill_holes(mesh, {.longest_border = 100, .largest_share = 1});
  CHECK(filled.holes == 1);
  CHECK(is_closed(filled.mesh));
  const TriangleMesh crossed =
      of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, -1}, {0.5, 0.5, -2}, {0.2, 0.5, -3}},
         {{1, 0, 4}, {2, 1, 4}, {3, 2, 4}, {0, 3, 4}, {0, 2, 5}, {1, 3, 6}});
  filled = fill_holes(crossed, {.longest_border = 100, .largest_share = 1});
  REQUIRE(filled.holes > 0);
  CHECK(begins_with(filled.mesh, crossed));
  CHECK(max_triangles_on_an_edge(filled.mesh) == 2);
}

TEST_CASE("surfaces that are none: nothing crashes, nothing given changes") {
  Random random(7);
  int closed = 0;
  for (int trial = 0; trial < 200; ++trial) {
    TriangleMesh mesh;
    const int32_t vertices = 4 + static_cast<int32_t>(random.below(12));
    mesh.positions.resize(vertices, 3);
    mesh.triangles.resize(1 + random.below(30), 3);
    for (Eigen::Index i = 0; i < mesh.positions.size(); ++i)  // many equal places, too
      mesh.positions.data()[i] = static_cast<double>(random.below(3));
    for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
      const auto corners = sample_without_replacement(random, vertices, 3);
      mesh.triangles.row(t) << corners[0], corners[1], corners[2];
    }
    const FilledMesh filled = fill_holes(mesh, {.longest_border = 1e9, .largest_share = 1e9});
    if (filled.holes == 0) continue;
    ++closed;
    CHECK(begins_with(filled.mesh, mesh));
    CHECK(filled.mesh.positions.allFinite());
    CHECK(filled.mesh.triangles.maxCoeff() < filled.mesh.vertex_count());
  }
  CHECK(closed > 20);
  CHECK(fill_holes(TriangleMesh{}).holes == 0);
}

TEST_CASE("a loop of hundreds of vertices is closed, quickly") {
  const TriangleMesh holed = without(sphere(7), [](const Vector3& p) { return p.z() > 0.8; });
  const auto loops = border_loops(holed);
  REQUIRE(loops.size() == 1);
  CHECK(loops[0].size() > 240);
  const FilledMesh filled = fill_holes(holed, {.longest_border = 2, .largest_share = 0.2});
  CHECK(filled.holes == 1);
  CHECK(is_closed(filled.mesh));
  CHECK(volume(filled.mesh) == doctest::Approx(4 * pi / 3).epsilon(0.02));
}
