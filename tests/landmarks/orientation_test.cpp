// Which headings are tried: a forest that learned where things lie in a body's frame agrees in that frame only.
#include "landmarks/orientation.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "forest/regression_forest.h"
#include "landmarks/features.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

constexpr int32_t samples = 400;

std::shared_ptr<const PreparedMesh> body(const Matrix3& turn) {
  TriangleMesh mesh = with_radius(sphere(4), lump);
  mesh.positions = (mesh.positions * turn.transpose()).eval();
  return std::make_shared<PreparedMesh>(prepare(std::move(mesh)));
}

SurfaceAnalysis analysed(const Matrix3& turn) {
  return analyse_surface(body(turn), {.eigenpair_count = 30, .sampling_rate = 0.5, .seed = 5}, {});
}

// A forest of distances to three points, learned from the body as it stands.
LandmarkModel model_of_body() {
  const SurfaceAnalysis analysis = analysed(Matrix3::Identity());
  LandmarkModel model;
  model.landmark_names = {"a", "b", "c"};
  model.params.tree_count = 10;
  const std::vector<int32_t> marks = {0, 3, 4};
  const RowMatrixf fields = analysis.metric->distances(marks, {});
  RowMatrixf targets(samples, 3);
  model.targets.resize(samples, 3), model.reach = fields.maxCoeff();
  for (int32_t s = 0; s < samples; ++s)
    for (int32_t l = 0; l < 3; ++l) {
      targets(s, l) = fields(l, analysis.samples[s]);
      model.targets(s, l) = static_cast<uint16_t>(targets(s, l) / model.reach * target_steps);
    }
  const RowMatrixf features = features_of(analysis, samples, model.params, Matrix3::Identity());
  model.forests = {grow_forest(bin_descriptors(features, {}), targets, {.tree_count = 10}, {})};
  return model;
}

bool is_turn(const Matrix3& m) {
  return (m * m.transpose() - Matrix3::Identity()).norm() < 1e-12 && m.determinant() > 0.5;
}

}  // namespace

TEST_CASE(
    "headings: as the training shapes stand, then backwards, then others where the trees agree better") {
  const LandmarkModel model = model_of_body();
  const Matrix3 back = Eigen::AngleAxisd(M_PI, Vector3::UnitY()).toRotationMatrix();
  const auto upright =
      headings_to_try(model, analysed(Matrix3::Identity()), DetectParams::Orientation::upright, {});
  REQUIRE(upright.size() == 2);  // it stands as learned: nothing is clearly better
  CHECK(upright[0].frame == Matrix3::Identity());
  CHECK(upright[0].penalty == 0);
  CHECK((upright[1].frame - back).norm() < 1e-12);
  CHECK(upright[1].penalty > 0);
  for (const Vector3& axis : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)}) {
    const Matrix3 turn = Eigen::AngleAxisd(M_PI / 2, axis).toRotationMatrix();
    const auto headings = headings_to_try(model, analysed(turn), DetectParams::Orientation::upright, {});
    REQUIRE(headings.size() > 2);
    for (const Heading& heading : headings) CHECK(is_turn(heading.frame));
    const auto right = std::find_if(headings.begin(), headings.end(), [&](const Heading& heading) {
      return (heading.frame - turn.transpose()).norm() < 1e-9;
    });
    REQUIRE(right != headings.end());
    CHECK(right - headings.begin() == 2);  // the best of those that are not tried anyway
    CHECK((right->penalty > upright[1].penalty) ==
          (axis.y() == 0));  // lying down costs more than facing elsewhere
  }
}

TEST_CASE("headings: any way costs nothing, and four are tried; a model without an orientation has one") {
  LandmarkModel model = model_of_body();
  const SurfaceAnalysis analysis = analysed(Matrix3::Identity());
  const auto headings = headings_to_try(model, analysis, DetectParams::Orientation::any_way, {});
  CHECK(headings.size() == 4);
  for (const Heading& heading : headings) CHECK(heading.penalty == 0);
  for (size_t a = 0; a < headings.size(); ++a)
    for (size_t b = 0; b < a; ++b) CHECK((headings[a].frame - headings[b].frame).norm() > 1);
  model.params.oriented = false;
  const auto only = headings_to_try(model, analysis, DetectParams::Orientation::any_way, {});
  REQUIRE(only.size() == 1);
  CHECK(only[0].frame == Matrix3::Identity());
}
