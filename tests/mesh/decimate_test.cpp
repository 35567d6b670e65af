// Decimated surfaces: closed, near the original, the same bits for any number of threads, in one piece or by slabs.
#include "mesh/decimate.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "mesh/prepare.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

// Larger than what is decimated in one piece, and long, so that the slabs' borders cross the surface.
const TriangleMesh& large_ellipsoid() {
  static const TriangleMesh mesh = [] {
    TriangleMesh made = sphere(7);
    made.positions = made.positions * Vector3(1, 3, 1).asDiagonal();
    return made;
  }();
  return mesh;
}

}  // namespace

TEST_CASE("a large surface is decimated by slabs to what was asked for, closed and near the original") {
  const TriangleMesh& mesh = large_ellipsoid();
  REQUIRE(mesh.vertex_count() > 60000);
  const TriangleMesh coarse =
      decimate(mesh, 3500, {.thread_count = 2, .task = nullptr, .host_parallel_for = {}});
  CHECK(std::abs(coarse.vertex_count() - 3500) < 100);
  CHECK(is_closed(coarse));
  CHECK(coarse.vertex_count() - coarse.triangle_count() / 2 == 2);
  CHECK(surface_area(coarse) == doctest::Approx(surface_area(mesh)).epsilon(0.003));
  // Vertices are spread as the quadrics want it, not crowded where the slabs meet.
  double longest = 0;
  const auto edges = edges_of(coarse);
  for (Eigen::Index e = 0; e < edges.rows(); ++e)
    longest =
        std::max(longest, (coarse.positions.row(edges(e, 0)) - coarse.positions.row(edges(e, 1))).norm());
  CHECK(longest < 6 * mean_edge_length(coarse));
}

TEST_CASE("the same bits for one, two and four threads") {
  const TriangleMesh one =
      decimate(large_ellipsoid(), 2000, {.thread_count = 1, .task = nullptr, .host_parallel_for = {}});
  for (const int count : {2, 4}) {
    const TriangleMesh other =
        decimate(large_ellipsoid(), 2000, {.thread_count = count, .task = nullptr, .host_parallel_for = {}});
    CHECK(one.positions == other.positions);
    CHECK(one.triangles == other.triangles);
  }
}

TEST_CASE("a cancelled decimation stops") {
  Task task;
  task.cancel();
  Execution execution = {.thread_count = 2, .task = nullptr, .host_parallel_for = {}};
  execution.task = &task;
  CHECK_THROWS_AS(decimate(large_ellipsoid(), 2000, execution), Error);
}
