// Heat distances where the true ones are known.
#include "geodesics/heat_method.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/random.h"
#include "mesh/prepare.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

RowMatrixf distances_from(const TriangleMesh& mesh, std::vector<int32_t> sources,
                          const Execution& execution = {}) {
  return HeatMethod(mesh, make_operators(mesh)).distances(sources, execution);
}

}  // namespace

TEST_CASE("on the plane, distances from the centre are those of Euclid to 1 %") {
  for (const double jitter : {0.0, 0.25}) {
    const int half = 50;
    const TriangleMesh mesh = square(half, jitter);
    const int32_t centre = mesh.vertex_count() / 2;
    const RowMatrixf d = distances_from(mesh, {centre});
    const Vector3 origin = mesh.positions.row(centre);
    double error = 0, relative_error = 0, worst = 0;
    int32_t count = 0;
    for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
      const double truth = (mesh.positions.row(v).transpose() - origin).norm();
      if (truth < 0.1 || truth > 0.8) continue;  // interior, and more than a few edges away
      const double off = std::abs(d(0, v) - truth);
      error += off, relative_error += off / truth, ++count;
      worst = std::max(worst, off);
    }
    MESSAGE("jitter " << jitter << ": mean error " << error / count << ", relative "
                      << relative_error / count);
    CHECK(d(0, centre) == 0);
    CHECK(error / count < 0.01 * 0.8);  // of the largest distance looked at
    CHECK(relative_error / count < 0.0125);
    CHECK(worst < 0.02);
  }
}

TEST_CASE("on the sphere, distances are arcs to 1 % of the largest") {
  const TriangleMesh mesh = sphere(5);
  const std::vector<int32_t> sources = {0, 100, 2000};
  const RowMatrixf d = distances_from(mesh, sources);
  for (size_t s = 0; s < sources.size(); ++s) {
    double error = 0;
    for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
      const double cosine = mesh.positions.row(v).dot(mesh.positions.row(sources[s]));
      error += std::abs(d(s, v) - std::acos(std::clamp(cosine, -1.0, 1.0)));
    }
    CHECK(error / mesh.vertex_count() < 0.01 * std::numbers::pi);
  }
}

TEST_CASE("distances grow with the mesh, do not move with it, and are nearly symmetric") {
  TriangleMesh mesh = with_radius(sphere(4), lump);
  std::vector<int32_t> all(mesh.vertex_count());
  std::iota(all.begin(), all.end(), 0);
  const RowMatrixf d = distances_from(mesh, all);
  const float diameter = d.maxCoeff();
  CHECK(d.minCoeff() >= 0);
  CHECK((d - d.transpose()).cwiseAbs().maxCoeff() < 0.05F * diameter);
  CHECK((d - d.transpose()).cwiseAbs().mean() < 0.01F * diameter);
  Random random(4);
  mesh.positions =
      ((1000 * mesh.positions * random_rotation(random)).rowwise() + Eigen::RowVector3d(5, 6, 7)).eval();
  const RowMatrixf moved = distances_from(mesh, {7, 500});
  CHECK((moved.row(0) / 1000 - d.row(7)).cwiseAbs().maxCoeff() < 1e-4F * diameter);
  CHECK((moved.row(1) / 1000 - d.row(500)).cwiseAbs().maxCoeff() < 1e-4F * diameter);
}

TEST_CASE("a source between vertices lies between them") {
  const TriangleMesh mesh = square(30, 0.2);
  const HeatMethod heat(mesh, make_operators(mesh));
  const SurfacePoint point{mesh.triangle_count() / 2 + 31, Vector3(0.2, 0.5, 0.3)};
  const SurfacePoint corner{point.triangle, Vector3(0, 1, 0)};
  const std::vector<SurfacePoint> points = {point, corner};
  const RowMatrixf d = heat.distances(points, {});
  const std::vector<int32_t> vertex = {mesh.triangles(point.triangle, 1)};
  CHECK((heat.distances(vertex, {}).row(0) - d.row(1)).cwiseAbs().maxCoeff() < 1e-5F);
  const Vector3 origin = position_of(mesh, point);
  double error = 0;
  int32_t count = 0;
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
    const double truth = (mesh.positions.row(v).transpose() - origin).norm();
    if (truth < 0.1 || truth > 0.7) continue;
    error += std::abs(d(0, v) - truth) / truth, ++count;
  }
  CHECK(error / count < 0.015);
}

TEST_CASE("the same bits for any number of threads, and for a source alone or in company") {
  const TriangleMesh mesh = with_radius(sphere(4), lump);
  const HeatMethod heat(mesh, make_operators(mesh));
  std::vector<int32_t> sources(75);  // two full blocks and a part of one
  for (int32_t i = 0; i < 75; ++i) sources[i] = 13 * i;
  Execution one, two;
  one.thread_count = 1, two.thread_count = 2;
  const RowMatrixf d = heat.distances(sources, one);
  CHECK(d == heat.distances(sources, two));
  const std::vector<int32_t> last = {sources.back()};
  CHECK(heat.distances(last, one).row(0) == d.row(74));
}

TEST_CASE("bridged parts are a finite distance apart") {
  const TriangleMesh one = sphere(3);
  const int32_t n = one.vertex_count();
  TriangleMesh both{MatrixX3(2 * n, 3), MatrixX3i(2 * one.triangle_count(), 3)};
  both.positions << one.positions, one.positions.rowwise() + Eigen::RowVector3d(2.1, 0, 0);
  both.triangles << one.triangles, (one.triangles.array() + n).matrix();
  const PreparedMesh mesh = prepare(both);
  const std::vector<int32_t> sources = {1};  // (-1, 0, 0), far from the other part
  const auto bridges = bridges_of(mesh);
  const HeatMethod heat(mesh.surface, make_operators(mesh.surface, bridges), {}, false, bridges);
  const RowMatrixf d = heat.distances(sources, {});
  CHECK(d.allFinite());
  CHECK(d.row(0).tail(n).minCoeff() > d.row(0).head(n).mean());  // the other part lies beyond
}

TEST_CASE("what lies beyond a bridge is farther by the length of its gap") {
  const TriangleMesh one = sphere(3);
  const int32_t n = one.vertex_count();
  for (const double gap : {0.5, 20.0}) {
    TriangleMesh both{MatrixX3(2 * n, 3), MatrixX3i(2 * one.triangle_count(), 3)};
    both.positions << one.positions, one.positions.rowwise() + Eigen::RowVector3d(2 + gap, 0, 0);
    both.triangles << one.triangles, (one.triangles.array() + n).matrix();
    PrepareParams as_it_is;
    as_it_is.analysed = AnalysedSurface::as_it_is;
    const PreparedMesh mesh = prepare(both, as_it_is);
    const auto bridges = bridges_of(mesh);
    const HeatMethod heat(mesh.surface, make_operators(mesh.surface, bridges), {}, false, bridges);
    for (const int32_t source : {int32_t{1}, n + 1}) {  // from either side
      const std::vector<int32_t> sources = {source};
      const Vector d = (mesh.scale * heat.distances(sources, {}).row(0)).cast<double>().transpose();
      const bool first = source < n;
      const double near = first ? d.head(n).maxCoeff() : d.tail(n).maxCoeff();
      const double far = first ? d.tail(n).minCoeff() : d.head(n).minCoeff();
      CAPTURE(gap);
      CHECK(far > gap);
      CHECK(far < near + 1.3 * gap + 0.5);
    }
  }
}

TEST_CASE("cancelling stops it") {
  const TriangleMesh mesh = sphere(3);
  Task task;
  task.cancel();
  Execution execution;
  execution.task = &task;
  const HeatMethod heat(mesh, make_operators(mesh));
  const std::vector<int32_t> sources = {0};
  CHECK_THROWS(heat.distances(sources, execution));
}
