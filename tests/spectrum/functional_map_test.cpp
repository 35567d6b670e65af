// Maps between a surface and itself, or itself in another place: where they must lead is known.
#include "spectrum/functional_map.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "base/random.h"
#include "operators/operators.h"
#include "spectrum/eigenbasis.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

// A sphere with a lump: no symmetry is left.
TriangleMesh lumpy() { return with_radius(sphere(4), lump); }

RowMatrixf eigenfunctions(const TriangleMesh& mesh) {
  const Operators operators = make_operators(mesh);
  EigenParams params;
  params.count = 64;
  return eigenbasis(operators.L, operators.mass, params, {}).Phi.cast<float>();
}

int32_t nearest_by_hand(const RowMatrixf& targets, const Eigen::VectorXf& place) {
  Eigen::Index best = 0;
  (targets.rowwise() - place.transpose()).rowwise().squaredNorm().minCoeff(&best);
  return static_cast<int32_t>(best);
}

}  // namespace

TEST_CASE("nearest rows are those that looking at each finds") {
  Random random(1);
  const auto fill = [&](int rows, int columns) {
    RowMatrixf result(rows, columns);
    for (float& x : result.reshaped()) x = static_cast<float>(random.normal());
    return result;
  };
  for (const auto& [places, targets, columns] :
       {std::array{1, 1, 1}, std::array{37, 70, 5}, std::array{300, 1025, 33}}) {
    const RowMatrixf a = fill(places, columns), b = fill(targets, columns);
    const auto nearest = nearest_rows(a, b);
    REQUIRE(nearest.size() == static_cast<size_t>(places));
    for (int i = 0; i < places; ++i) CHECK(nearest[i] == nearest_by_hand(b, a.row(i).transpose()));
  }
}

TEST_CASE("farthest points are different, and cover the surface") {
  const TriangleMesh mesh = sphere(4);
  auto points = farthest_points(mesh.positions, 100);
  REQUIRE(points.size() == 100);
  double farthest = 0;
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
    double nearest = 10;
    for (const int32_t p : points)
      nearest = std::min(nearest, (mesh.positions.row(v) - mesh.positions.row(p)).norm());
    farthest = std::max(farthest, nearest);
  }
  CHECK(farthest < 0.35);  // 100 discs of this radius hardly cover the unit sphere any better
  std::sort(points.begin(), points.end());
  CHECK(std::adjacent_find(points.begin(), points.end()) == points.end());
}

TEST_CASE("a rough start is refined to the map that is known: a surface to itself") {
  const TriangleMesh mesh = lumpy();
  const RowMatrixf Phi = eigenfunctions(mesh);
  const MatrixX3 unit = mesh.positions / std::sqrt(surface_area(mesh));
  const auto points = farthest_points(mesh.positions, 300);
  SpectralSamples from{RowMatrixf(300, Phi.cols()), Eigen::VectorXf::Constant(300, 1.0f / 300)};
  std::vector<int32_t> rough;
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    from.Phi.row(i) = Phi.row(points[i]);
    const auto near = connected_ball(make_operators(mesh).L, mesh.positions, points[i], 0.3);
    rough.push_back(near[random.below(static_cast<uint32_t>(near.size()))]);
  }
  const FunctionalMap map = zoom_out(from, {Phi, farthest_points(mesh.positions, 800), unit}, rough,
                                     {.first = 16, .last = 64, .step = 8});
  double before = 0, after = 0;
  for (int i = 0; i < 300; ++i) {
    before += (mesh.positions.row(rough[i]) - mesh.positions.row(points[i])).norm() / 300;
    after += (mesh.positions.row(map.image[i]) - mesh.positions.row(points[i])).norm() / 300;
  }
  CHECK(before > 0.1);
  CHECK(after < 0.02);
  CHECK((map.C - Eigen::MatrixXf::Identity(64, 64)).norm() / 8 < 0.1);
  CHECK(map.residual < 0.1);

  // Points before exact_from stay at vertices of the spread; those after it lie at the nearest of all.
  const auto spread = farthest_points(mesh.positions, 400);
  const FunctionalMap partly =
      zoom_out(from, {Phi, spread, unit}, rough, {.first = 16, .last = 64, .step = 8, .exact_from = 200});
  for (int i = 0; i < 200; ++i)
    CHECK(std::find(spread.begin(), spread.end(), partly.image[i]) != spread.end());
  double exact = 0;
  for (int i = 200; i < 300; ++i)
    exact += (mesh.positions.row(partly.image[i]) - mesh.positions.row(points[i])).norm() / 100;
  CHECK(exact < 0.03);
}
