// Forests on functions they must be able to learn, and the layout others rely on.
#include "forest/regression_forest.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"

using namespace focal;

namespace {

RowMatrixf random_descriptors(Eigen::Index rows, Eigen::Index columns, uint64_t seed) {
  Random random(seed);
  RowMatrixf x(rows, columns);
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] = static_cast<float>(random.uniform());
  return x;
}

// Two outputs: a step in component 2, and a smooth function of components 0 and 1.
RowMatrixf targets_of(const RowMatrixf& x) {
  RowMatrixf y(x.rows(), 2);
  for (Eigen::Index s = 0; s < x.rows(); ++s)
    y.row(s) << (x(s, 2) > 0.3F ? 1.0F : 0.0F), std::sin(3 * x(s, 0)) + x(s, 1);
  return y;
}

RegressionForest learn(const RowMatrixf& x, const RowMatrixf& y, const ForestParams& params,
                       int32_t threads = 1) {
  Execution execution;
  execution.thread_count = threads;
  return grow_forest(bin_descriptors(x, execution), y, params, execution);
}

}  // namespace

TEST_CASE("a forest learns a step function exactly, away from the step") {
  const RowMatrixf x = random_descriptors(3000, 6, 1), test = random_descriptors(500, 6, 2);
  const RowMatrixf y = targets_of(x).leftCols(1);
  RegressionForest forest = learn(x, y, {.tree_count = 10, .components_per_split = 6});
  keep_leaf_means(forest, y, 0);
  const Eigen::VectorXf predicted = predict_means(forest, test, {});
  for (Eigen::Index s = 0; s < test.rows(); ++s)
    if (std::abs(test(s, 2) - 0.3F) > 0.01F) CHECK(predicted[s] == (test(s, 2) > 0.3F ? 1.0F : 0.0F));
}

TEST_CASE("a forest follows a smooth function among components that say nothing") {
  const RowMatrixf x = random_descriptors(5000, 10, 3), test = random_descriptors(500, 10, 4);
  const RowMatrixf y = targets_of(x).rightCols(1), truth = targets_of(test).rightCols(1);
  RegressionForest forest = learn(x, y, {.tree_count = 20});
  keep_leaf_means(forest, y, 0);
  const Eigen::VectorXf predicted = predict_means(forest, test, {});
  const double variance = (truth.array() - truth.mean()).square().mean();
  CHECK((predicted - truth.col(0)).squaredNorm() / 500 < 0.03 * variance);
}

TEST_CASE("trees lie breadth first and every sample rests in one leaf, the one its descriptor leads to") {
  const RowMatrixf x = random_descriptors(1000, 5, 5), y = targets_of(x);
  const ForestParams params{.tree_count = 4, .min_leaf_samples = 7, .min_split_samples = 20};
  const RegressionForest forest = learn(x, y, params);
  REQUIRE(forest.trees.size() == 4);
  for (const RegressionTree& tree : forest.trees) {
    int32_t inner = 0, leaf = 0;
    for (size_t node = 0; node < tree.feature.size(); ++node) {  // what the model file builds upon
      const bool is_leaf = tree.feature[node] < 0;
      CHECK(tree.child[node] == (is_leaf ? leaf : 2 * inner + 1));
      ++(is_leaf ? leaf : inner);
    }
    REQUIRE(static_cast<int32_t>(tree.leaf_start.size()) == leaf + 1);
    std::vector<int32_t> seen(1000, 0);
    for (int32_t i = 0; i < leaf; ++i) {
      CHECK(tree.leaf_start[i + 1] - tree.leaf_start[i] >= params.min_leaf_samples);
      for (int32_t k = tree.leaf_start[i]; k < tree.leaf_start[i + 1]; ++k) {
        const int32_t sample = tree.leaf_samples[k];
        ++seen[sample];
        CHECK(tree.leaf_of(x.row(sample).data()) == i);
      }
    }
    CHECK(std::all_of(seen.begin(), seen.end(), [](int32_t n) { return n == 1; }));
  }
}

TEST_CASE("where there is nothing to gain there is no split") {
  const RowMatrixf x = random_descriptors(100, 3, 6);
  RegressionForest forest = learn(x, RowMatrixf::Constant(100, 2, 0.7F), {.tree_count = 2});
  CHECK(forest.trees[0].feature.size() == 1);
  const RegressionForest same_descriptor = learn(RowMatrixf::Ones(100, 3), targets_of(x), {.tree_count = 2});
  CHECK(same_descriptor.trees[1].feature.size() == 1);
  keep_leaf_means(forest, RowMatrixf::Constant(100, 2, 0.7F), 1);
  CHECK(predict_means(forest, x, {})[99] == doctest::Approx(0.7));
}

TEST_CASE("the same forest for any number of threads; another for another seed") {
  const RowMatrixf x = random_descriptors(2000, 8, 7), y = targets_of(x);
  ForestParams params{.tree_count = 6, .seed = 5};
  const RegressionForest one = learn(x, y, params, 1), two = learn(x, y, params, 2);
  for (size_t t = 0; t < one.trees.size(); ++t) {
    CHECK(one.trees[t].feature == two.trees[t].feature);
    CHECK(one.trees[t].threshold == two.trees[t].threshold);
    CHECK(one.trees[t].leaf_samples == two.trees[t].leaf_samples);
  }
  CHECK(one.trees[0].feature != one.trees[1].feature);
  params.seed = 6;
  CHECK(learn(x, y, params).trees[0].feature != one.trees[0].feature);
}

TEST_CASE("steps of a descriptor hold equal values together and keep their order") {
  RowMatrixf x = random_descriptors(2000, 2, 8);
  for (Eigen::Index s = 0; s < 1500; ++s) x(s, 1) = 0.5F;  // many equal values
  const BinnedDescriptors binned = bin_descriptors(x, {});
  for (int f = 0; f < 2; ++f) {
    CHECK(std::is_sorted(binned.upper[f].begin(), binned.upper[f].end()));
    CHECK(binned.upper[f].size() < 256);
    for (Eigen::Index s = 0; s + 1 < 2000; ++s) {
      const Eigen::Index r = s + 1;
      if (x(s, f) == x(r, f)) CHECK(binned.bins(s, f) == binned.bins(r, f));
      if (x(s, f) < x(r, f)) CHECK(binned.bins(s, f) <= binned.bins(r, f));
      if (x(s, f) > x(r, f)) CHECK(binned.bins(s, f) >= binned.bins(r, f));
    }
  }
}
