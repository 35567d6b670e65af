// Which training shapes are most like a new one, by forests made up by hand.
#include "landmarks/exemplar_choice.h"

#include <doctest/doctest.h>

#include "model/model_file.h"
#include "model/small_model.h"

using namespace focal;

namespace {

// One test of the first component: up to 0 these samples, above it those.
RegressionTree stump(std::vector<int32_t> low, const std::vector<int32_t>& high) {
  RegressionTree tree;
  tree.feature = {0, -1, -1}, tree.threshold = {0, 0, 0}, tree.child = {1, 0, 1};
  tree.leaf_start = {0, static_cast<int32_t>(low.size()), static_cast<int32_t>(low.size() + high.size())};
  low.insert(low.end(), high.begin(), high.end());
  tree.leaf_samples = std::move(low);
  return tree;
}

// Four shapes: the first of four samples, the others of one each.
LandmarkModel model_of_four() {
  LandmarkModel model;
  model.landmark_names = {"a", "b"};
  model.exemplars.resize(4);
  model.sample_shape = {0, 0, 0, 0, 1, 2, 3};
  model.targets = TargetMatrix::Zero(7, 2);
  model.reach = 2;
  model.forests = {{{stump({0, 4}, {1, 2, 3, 5, 6}), stump({4, 5}, {0, 1, 2, 3, 6})}}};
  return model;
}

RowMatrixf features(std::vector<float> first) {
  return Eigen::Map<RowMatrixf>(first.data(), static_cast<Eigen::Index>(first.size()), 1);
}

}  // namespace

TEST_CASE(
    "exemplars: those come first whose samples share the leaves, whatever the number of their samples") {
  const LandmarkModel model = model_of_four();
  // Low: leaves {0, 4} and {4, 5}: shape 1 has 1/2 + 1/2, shape 2 1/2, shape 0 1/2 of four samples, shape 3 nothing.
  CHECK(most_alike(model, features({-1}), 3) == std::vector<int32_t>{1, 2, 0});
  // High: leaves {1, 2, 3, 5, 6} and {0, 1, 2, 3, 6}: shape 3 has 2/5, shape 0 7/20, shape 2 1/5, shape 1 nothing.
  CHECK(most_alike(model, features({1, 1, 1}), 3) == std::vector<int32_t>{3, 0, 2});
  CHECK(most_alike(model, features({-1}), 1) == std::vector<int32_t>{1});
}

TEST_CASE(
    "exemplars: all of them in their order where there are few, or where the model does not say whose its "
    "samples are") {
  LandmarkModel model = model_of_four();
  CHECK(most_alike(model, features({-1}), 4) == std::vector<int32_t>{0, 1, 2, 3});
  model.sample_shape.clear();
  CHECK(most_alike(model, features({-1}), 2) == std::vector<int32_t>{0, 1, 2, 3});
}

TEST_CASE("exemplars: what they say of the landmarks is what training would learn from them alone") {
  LandmarkModel model = focal_test::small_model_of_exemplars();
  const std::vector<int32_t> both = {0, 1}, second = {1};
  CHECK(statistics_of(model, both).distance_mean == model.constellation.distance_mean);
  const ConstellationStatistics learned =
      learn_constellation(std::vector{model.exemplars[1].constellation}, 3);
  const ConstellationStatistics found = statistics_of(model, second);
  CHECK(found.landmarks == 3);
  CHECK(found.distance_mean == learned.distance_mean);
  CHECK(found.chirality_mean == learned.chirality_mean);
  CHECK(found.distance_mean != model.constellation.distance_mean);
  // What the file does not keep has no say before either.
  model.exemplars[1].constellation.directions.x.setConstant(0.123F);
  model.exemplars[1].constellation.directions.y(0, 1) = 1;
  CHECK(statistics_of(parse_model(serialise(model)), second).chirality_mean ==
        statistics_of(model, second).chirality_mean);
  model =
      focal_test::small_model(Preset::default_preset);  // of an older version: of all shapes together only
  CHECK(statistics_of(model, second).distance_mean == model.constellation.distance_mean);
}

TEST_CASE("exemplars: trees disagree by the deviation of what they say") {
  LandmarkModel model = model_of_four();
  CHECK(disagreement(model, features({-1, 1})) == 0);
  model.targets.row(4).setConstant(target_steps);  // distance 2 on shape 1
  // Low: the trees say (0 + 2) / 2 and (2 + 0) / 2; high: nothing of it.
  CHECK(disagreement(model, features({-1, 1})) == doctest::Approx(0));
  model.targets.row(5).setConstant(target_steps);  // and on shape 2: 1 against 2, and 2/5 against 0
  CHECK(disagreement(model, features({-1})) == doctest::Approx(0.5));
  CHECK(disagreement(model, features({1})) == doctest::Approx(0.2));
  CHECK(disagreement(model, features({-1, 1})) == doctest::Approx(0.35));
  model.targets.row(5).setConstant(target_missing);  // says nothing: 1 against 2
  CHECK(disagreement(model, features({-1})) == doctest::Approx(0.5));
  model.targets.col(1).setConstant(target_missing);  // a landmark of which no leaf knows: no tree disagrees
  CHECK(disagreement(model, features({-1})) == doctest::Approx(0.25));
}
