// Damage keeps its word: what is lost, where everything else came from, and the marks.
#include "augmentation/corruption.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <set>

#include "kit/corruption.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

using Marks = std::vector<std::optional<SurfacePoint>>;

Marks some_marks(const TriangleMesh& mesh, int count, uint64_t seed) {
  Random random(seed);
  Marks marks;
  for (int i = 0; i < count; ++i) {
    const auto t = static_cast<int32_t>(random.below(mesh.triangle_count()));
    const Vector3 weights(random.uniform() + 0.01, random.uniform(), random.uniform());
    marks.push_back(SurfacePoint{t, i % 3 ? Vector3(weights / weights.sum()) : Vector3::Unit(i % 9 / 3)});
  }
  return marks;
}

// Directed edges without a partner.
int border_edges(const TriangleMesh& mesh) {
  std::set<std::pair<int32_t, int32_t>> directed;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) directed.emplace(mesh.triangles(t, i), mesh.triangles(t, (i + 1) % 3));
  int count = 0;
  for (const auto& [a, b] : directed) count += !directed.contains({b, a});
  return count;
}

bool same(const CorruptedMesh& a, const CorruptedMesh& b) {
  bool marks = a.marks.size() == b.marks.size();
  for (size_t i = 0; marks && i < a.marks.size(); ++i) {
    marks = a.marks[i].has_value() == b.marks[i].has_value();
    if (marks && a.marks[i])
      marks =
          a.marks[i]->triangle == b.marks[i]->triangle && a.marks[i]->barycentric == b.marks[i]->barycentric;
  }
  return marks && a.mesh.positions == b.mesh.positions && a.mesh.triangles == b.mesh.triangles &&
         a.old_vertex == b.old_vertex && a.old_triangle == b.old_triangle;
}

// Every surviving mark lies where it lay, and every map names what it says, for damages that move nothing.
void check_in_place(const TriangleMesh& before, const Marks& marks, const CorruptedMesh& after) {
  REQUIRE(after.marks.size() == marks.size());
  REQUIRE(static_cast<int32_t>(after.old_vertex.size()) == after.mesh.vertex_count());
  REQUIRE(static_cast<int32_t>(after.old_triangle.size()) == after.mesh.triangle_count());
  for (size_t i = 0; i < marks.size(); ++i)
    if (after.marks[i]) {
      const SurfacePoint& mark = *after.marks[i];
      CHECK(mark.barycentric.minCoeff() >= 0);
      CHECK(mark.barycentric.sum() == doctest::Approx(1));
      CHECK((position_of(after.mesh, mark) - position_of(before, *marks[i])).norm() < 1e-12);
      CHECK(
          (after.old_triangle[mark.triangle] == marks[i]->triangle || marks[i]->barycentric.maxCoeff() == 1));
    }
  for (int32_t v = 0; v < after.mesh.vertex_count(); ++v)
    if (after.old_vertex[v] >= 0)
      CHECK(after.mesh.positions.row(v) == before.positions.row(after.old_vertex[v]));
}

int count_marks(const CorruptedMesh& corrupted) {
  int count = 0;
  for (const auto& mark : corrupted.marks) count += mark.has_value();
  return count;
}

}  // namespace

TEST_CASE("the same seed gives the same damage, another one another") {
  const TriangleMesh mesh = with_radius(sphere(4), lump);
  const auto all = [&](uint64_t seed) {
    Random random(seed);
    CorruptedMesh corrupted = intact(mesh, some_marks(mesh, 20, 1));
    corrupted = with_noise(std::move(corrupted), 0.1, random);
    corrupted = with_holes(std::move(corrupted), 5, 1.5, random);
    corrupted = resampled(std::move(corrupted), 1.5, random);
    corrupted = resampled(std::move(corrupted), 0.5, random);
    return moved(std::move(corrupted), random_similarity(3, 10, random));
  };
  CHECK(same(all(4), all(4)));
  CHECK(!same(all(4), all(5)));
}

TEST_CASE("noise has the deviation asked for and leaves the triangles and marks") {
  const TriangleMesh mesh = sphere(5);
  Random random(2);
  const Marks marks = some_marks(mesh, 9, 3);
  const CorruptedMesh noisy = with_noise(intact(mesh, marks), 0.3, random);
  const double edge = mean_edge_length(mesh);
  const MatrixX3 moves = (noisy.mesh.positions - mesh.positions) / edge;
  CHECK(moves.mean() == doctest::Approx(0).epsilon(0.01));
  CHECK(std::sqrt(moves.array().square().mean()) == doctest::Approx(0.3).epsilon(0.03));
  CHECK(noisy.mesh.triangles == mesh.triangles);
  CHECK(count_marks(noisy) == 9);
}

TEST_CASE("single-vertex holes lose their vertices and what hangs on them, and no more") {
  const TriangleMesh mesh = sphere(4);
  Random random(6);
  const Marks marks = some_marks(mesh, 60, 8);
  const CorruptedMesh holed = with_holes(intact(mesh, marks), 30, 0, random);
  CHECK(mesh.vertex_count() - holed.mesh.vertex_count() >= 30);
  CHECK(mesh.vertex_count() - holed.mesh.vertex_count() <= 33);  // neighbours may leave one without triangles
  check_in_place(mesh, marks, holed);
  const std::set<int32_t> left(holed.old_vertex.begin(), holed.old_vertex.end());
  const std::set<int32_t> triangles(holed.old_triangle.begin(), holed.old_triangle.end());
  int gone = 0;
  for (size_t i = 0; i < marks.size(); ++i) {
    Eigen::Index corner = 0;
    const bool at_vertex = marks[i]->barycentric.maxCoeff(&corner) == 1;
    const bool stays = at_vertex ? left.contains(mesh.triangles(marks[i]->triangle, corner))
                                 : triangles.contains(marks[i]->triangle);
    CHECK(holed.marks[i].has_value() == stays);
    gone += !stays;
  }
  CHECK(gone > 0);
}

TEST_CASE("wider holes have the radius asked for") {
  const TriangleMesh mesh = square(30);
  Random random(1);
  const CorruptedMesh holed = with_holes(intact(mesh), 1, 4, random);
  const double lost = 4 - surface_area(holed.mesh), edge = mean_edge_length(mesh);
  // Edge paths make an octagon or so of the disc, and every triangle that touches it goes.
  CHECK(lost > 0.6 * 3.14159 * 16 * edge * edge);
  CHECK(lost < 1.4 * 3.14159 * 25 * edge * edge);
}

TEST_CASE("a plane cuts off what lies beyond it, open or capped") {
  const TriangleMesh mesh = sphere(4);
  const Marks marks = some_marks(mesh, 50, 2);
  const Vector3 normal = Vector3(1, 2, 2) / 3;
  const CorruptedMesh open = cut_beyond(intact(mesh, marks), 0.4 * normal, normal, CutEnd::open);
  check_in_place(mesh, marks, open);
  CHECK((open.mesh.positions * normal).maxCoeff() <= 0.4);
  CHECK(border_edges(open.mesh) > 10);
  for (size_t i = 0; i < marks.size(); ++i) {
    const double height = position_of(mesh, *marks[i]).dot(normal);
    if (height > 0.4) CHECK(!open.marks[i]);
    if (height < 0.2) CHECK(open.marks[i]);
  }
  const CorruptedMesh capped = cut_beyond(intact(mesh, marks), 0.4 * normal, normal, CutEnd::capped);
  CHECK(border_edges(capped.mesh) == 0);
  CHECK(capped.mesh.vertex_count() == open.mesh.vertex_count() + 1);
  CHECK(capped.old_vertex.back() == -1);
  CHECK(capped.old_triangle.back() == -1);
  double volume = 0;
  for (int32_t t = 0; t < capped.mesh.triangle_count(); ++t) {
    const auto corner = [&](int i) -> Vector3 {
      return capped.mesh.positions.row(capped.mesh.triangles(t, i));
    };
    volume += corner(0).dot(corner(1).cross(corner(2))) / 6;
  }
  CHECK(volume == doctest::Approx(3.14159 * (4.0 / 3 - 0.36 * (3 - 0.6) / 3)).epsilon(0.06));
}

TEST_CASE("a cap closes the cut and leaves holes that were there") {
  TriangleMesh mesh = sphere(4);
  Random random(3);
  CorruptedMesh holed = cut_beyond(intact(mesh), Vector3(-0.9, 0, 0), Vector3(-1, 0, 0), CutEnd::open);
  const int border = border_edges(holed.mesh);
  CHECK(border > 0);
  holed = cut_beyond(std::move(holed), Vector3(0.5, 0, 0), Vector3(1, 0, 0), CutEnd::capped);
  CHECK(border_edges(holed.mesh) == border);
}

TEST_CASE("a ball takes a limb off, whole, and the marks on it") {
  const TriangleMesh mesh = with_radius(sphere(5), mirror_lump);  // its tail points to -z
  Eigen::Index tip = 0;
  mesh.positions.col(2).minCoeff(&tip);
  SurfacePoint centre;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i)
      if (mesh.triangles(t, i) == tip) centre = {t, Vector3::Unit(i)};
  const Vector lengths = edge_path_lengths(mesh, centre, std::numeric_limits<double>::infinity());
  Random random(1);
  const Marks marks = some_marks(mesh, 80, 9);
  const CorruptedMesh cut = cut_ball(intact(mesh, marks), centre, 1, CutEnd::open);
  check_in_place(mesh, marks, cut);
  for (const int32_t v : cut.old_vertex) CHECK(lengths[v] >= 1);
  CHECK(cut.mesh.vertex_count() > (lengths.array() >= 1).count() - 60);
  CHECK(count_marks(cut) < 80);
}

TEST_CASE("edge paths are no shorter than the geodesic and hardly longer") {
  const TriangleMesh mesh = sphere(5);
  const SurfacePoint from{100, Vector3(0.2, 0.3, 0.5)};
  const Vector lengths = edge_path_lengths(mesh, from, 10);
  const Vector3 place = position_of(mesh, from).normalized();
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
    const double exact = std::acos(std::clamp(place.dot(mesh.positions.row(v).transpose()), -1.0, 1.0));
    CHECK(lengths[v] >= 0.99 * exact - 0.02);
    CHECK(lengths[v] <= 1.2 * exact + 0.05);
  }
  CHECK(std::isinf(edge_path_lengths(mesh, from, 0.5).maxCoeff()));
}

TEST_CASE("a finer mesh is the same surface, closed as before, with the marks in place") {
  const TriangleMesh mesh = with_radius(sphere(4), lump);
  Random random(12);
  const Marks marks = some_marks(mesh, 50, 4);
  const CorruptedMesh fine = resampled(intact(mesh, marks), 2, random);
  CHECK(fine.mesh.vertex_count() == 2 * mesh.vertex_count());
  CHECK(fine.mesh.triangle_count() == 2 * (fine.mesh.vertex_count() - 2));
  CHECK(border_edges(fine.mesh) == 0);
  CHECK(surface_area(fine.mesh) == doctest::Approx(surface_area(mesh)).epsilon(1e-9));
  CHECK(count_marks(fine) == 50);
  check_in_place(mesh, marks, fine);
  for (int32_t t = 0; t < fine.mesh.triangle_count();
       ++t) {  // inside the triangle that it names, turned alike
    const auto normal = [](const TriangleMesh& m, int32_t k) -> Vector3 {
      const Vector3 a = m.positions.row(m.triangles(k, 0)), b = m.positions.row(m.triangles(k, 1)),
                    c = m.positions.row(m.triangles(k, 2));
      return (b - a).cross(c - a);
    };
    const Vector3 child = normal(fine.mesh, t), parent = normal(mesh, fine.old_triangle[t]);
    CHECK(child.normalized().dot(parent.normalized()) == doctest::Approx(1).epsilon(1e-6));
    CHECK(child.norm() <= parent.norm() * (1 + 1e-9));
  }
}

TEST_CASE("a coarser mesh keeps the shape, and the marks nearly in place") {
  const TriangleMesh mesh = with_radius(sphere(5), lump);
  Random random(12);
  const Marks marks = some_marks(mesh, 50, 4);
  const CorruptedMesh coarse = resampled(intact(mesh, marks), 0.5, random);
  CHECK(std::abs(coarse.mesh.vertex_count() - mesh.vertex_count() / 2) < 0.02 * mesh.vertex_count());
  CHECK(border_edges(coarse.mesh) == 0);
  CHECK(surface_area(coarse.mesh) == doctest::Approx(surface_area(mesh)).epsilon(0.02));
  CHECK(count_marks(coarse) == 50);
  for (size_t i = 0; i < marks.size(); ++i)
    CHECK((position_of(coarse.mesh, *coarse.marks[i]) - position_of(mesh, *marks[i])).norm() <
          0.2 * mean_edge_length(mesh));
  for (int32_t v = 0; v < coarse.mesh.vertex_count(); ++v)
    CHECK(coarse.mesh.positions.row(v) == mesh.positions.row(coarse.old_vertex[v]));
}

TEST_CASE("a random similarity scales by what it says and never mirrors") {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const Matrix4 map = random_similarity(2.5, 7, random);
    const Eigen::Matrix3d turn = map.topLeftCorner<3, 3>() / 2.5;
    CHECK((turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
    CHECK(turn.determinant() == doctest::Approx(1));
    CHECK(map.topRightCorner<3, 1>().cwiseAbs().maxCoeff() <= 7);
  }
  const TriangleMesh mesh = sphere(3);
  const Matrix4 map = random_similarity(2.5, 7, random);
  const Marks marks = some_marks(mesh, 5, 1);
  const CorruptedMesh there = moved(intact(mesh, marks), map);
  for (size_t i = 0; i < marks.size(); ++i) {
    const Eigen::Vector4d at = map * position_of(mesh, *marks[i]).homogeneous();
    CHECK((position_of(there.mesh, *there.marks[i]) - at.head<3>()).norm() < 1e-12);
  }
}

TEST_CASE("everything may be lost") {
  const TriangleMesh mesh = sphere(2);
  CorruptedMesh nothing =
      cut_beyond(intact(mesh, some_marks(mesh, 3, 1)), Vector3(0, 0, -5), Vector3(0, 0, 1), CutEnd::capped);
  CHECK(nothing.mesh.triangle_count() == 0);
  CHECK(nothing.mesh.vertex_count() == 0);
  CHECK(count_marks(nothing) == 0);
  Random random(1);
  nothing = with_noise(std::move(nothing), 1, random);
  nothing = with_holes(std::move(nothing), 5, 2, random);
  nothing = resampled(std::move(nothing), 2, random);
  nothing = resampled(std::move(nothing), 0.5, random);
  CHECK(nothing.mesh.triangle_count() == 0);
}
