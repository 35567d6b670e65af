// Which headings are tried, for a body whose points differ enough to say where they lie.
#include "landmarks/orientation.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forest/regression_forest.h"
#include "landmarks/features.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

using std::numbers::pi;

SurfaceAnalysis analysed(const Matrix3& turn, uint64_t seed = 5, int32_t max_described = 0) {
  TriangleMesh mesh = with_radius(sphere(4), lump);
  mesh.positions = (mesh.positions * turn.transpose()).eval();
  return analyse_surface(std::make_shared<PreparedMesh>(prepare(std::move(mesh))),
                         {.eigenpair_count = 30,
                          .sampling_rate = max_described ? 0.05 : 0.5,
                          .max_described = max_described,
                          .seed = seed},
                         {});
}

Matrix3 turn_about(const Vector3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

// Learned from the body as it stands, as training does.
LandmarkModel model_of_body() {
  const SurfaceAnalysis analysis = analysed(Matrix3::Identity());
  const Described of = first_samples(analysis, static_cast<int32_t>(analysis.samples.size()));
  LandmarkModel model;
  model.facing_targets = placed_features(analysis, of.vertices);
  RowMatrixf forwards = model.facing_targets;
  for (const Eigen::Index other : {0, 1, 3, 4}) forwards.col(other).setZero();
  const ForestParams how{.tree_count = 10};
  model.rising =
      grow_forest(bin_descriptors(invariant_features(analysis, of), {}), model.facing_targets, how, {});
  model.facing = grow_forest(bin_descriptors(upright_features(analysis, of, model.facing_targets), {}),
                             forwards, how, {});
  return model;
}

// Degrees from the frame that undoes the turn.
double degrees_off(const Heading& heading, const Matrix3& turn) {
  return Eigen::AngleAxisd(heading.frame * turn).angle() * 180 / pi;
}

const Heading& cheapest(const std::vector<Heading>& headings) {
  return *std::min_element(headings.begin(), headings.end(),
                           [](const Heading& a, const Heading& b) { return a.penalty < b.penalty; });
}

}  // namespace

TEST_CASE("headings: a body that stands as learned is tried so, and backwards, which costs more") {
  const auto headings =
      headings_to_try(model_of_body(), analysed(Matrix3::Identity()), DetectParams::Orientation::upright);
  REQUIRE(headings.size() == 2);
  CHECK(headings[0].frame.isIdentity(1e-12));
  CHECK(headings[1].frame.isApprox(turn_about({0, 1, 0}, pi), 1e-12));
  CHECK(headings[0].penalty < headings[1].penalty);
  CHECK(headings[0].advantage == doctest::Approx(headings[1].penalty - headings[0].penalty));
  CHECK(headings[1].advantage == doctest::Approx(-headings[0].advantage));
}

TEST_CASE("headings: one that faces elsewhere is tried as it faces") {
  const LandmarkModel model = model_of_body();
  for (const double angle : {pi / 2, -pi / 2, 0.75 * pi, pi}) {
    CAPTURE(angle);
    const Matrix3 turn = turn_about({0, 1, 0}, angle);
    const auto headings = headings_to_try(model, analysed(turn), DetectParams::Orientation::upright);
    const size_t upright = angle == pi ? 2 : 3;  // those about another up axis come later
    REQUIRE(headings.size() >= upright);
    for (size_t h = 0; h < upright; ++h)
      CHECK((headings[h].frame * Vector3::UnitY()).isApprox(Vector3::UnitY(), 1e-9));
    CHECK(degrees_off(headings[upright - 1], turn) < 15);
    CHECK(&cheapest(headings) == &headings[upright - 1]);
    CHECK(headings[upright - 1].advantage > 0);  // of one between the axes too, whose opposite is not tried
  }
}

TEST_CASE("headings: one that lies is tried upright, at a price; any way it costs nothing to lie") {
  const LandmarkModel model = model_of_body();
  for (const Vector3& axis : {Vector3(1, 0, 0), Vector3(0, 0, 1), Vector3(1, 0, -1).normalized().eval()}) {
    const Matrix3 turn = turn_about(axis, pi / 2);
    const SurfaceAnalysis lying = analysed(turn);
    const auto price_of_right = [&](DetectParams::Orientation orientation) {
      const auto headings = headings_to_try(model, lying, orientation);
      CHECK(headings.size() >= 4);
      const auto right = std::min_element(
          headings.begin(), headings.end(),
          [&](const Heading& a, const Heading& b) { return degrees_off(a, turn) < degrees_off(b, turn); });
      CHECK(degrees_off(*right, turn) < 15);
      for (const Heading& heading : headings) {
        CHECK((heading.frame * heading.frame.transpose()).isIdentity(1e-9));
        CHECK(heading.frame.determinant() > 0);
      }
      return right->penalty;
    };
    CHECK(price_of_right(DetectParams::Orientation::upright) >
          price_of_right(DetectParams::Orientation::any) + 1);
  }
}

TEST_CASE("headings: what they cost does not depend on the seed, which chooses the samples") {
  const LandmarkModel model = model_of_body();
  const auto penalty = [&](uint64_t seed, int32_t max_described) {
    return headings_to_try(model, analysed(Matrix3::Identity(), seed, max_described),
                           DetectParams::Orientation::upright)[1]
        .penalty;
  };
  const double first = penalty(1, 4000), by_samples = penalty(1, 0);
  double worst_by_samples = 0;
  for (const uint64_t seed : {2, 3, 4}) {
    CHECK(penalty(seed, 4000) == doctest::Approx(first).epsilon(1e-3));
    worst_by_samples = std::max(worst_by_samples, std::abs(penalty(seed, 0) - by_samples));
  }
  CHECK(worst_by_samples > 0.1);  // this is what it avoids
}

TEST_CASE("headings: a model without an orientation has one") {
  LandmarkModel model = model_of_body();
  model.params.oriented = false;
  const auto headings = headings_to_try(model, analysed(Matrix3::Identity()), DetectParams::Orientation::any);
  REQUIRE(headings.size() == 1);
  CHECK(headings[0].frame == Matrix3::Identity());
  CHECK(headings[0].penalty == 0);
  CHECK(std::isinf(headings[0].advantage));
}
