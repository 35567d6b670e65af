// Tables of votes against the sum written out: every remembered distance a Gaussian, all trees weighing the same.
#include "analysis/leaf_votes.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "model/small_model.h"

using namespace focal;
using namespace focal_test;

namespace {

constexpr double width = 0.0125, deviation = 0.024, mu = 5;

// Of one sample and landmark at distance d, with each target at the centre of its bin.
double naive(const LandmarkModel& model, const float* descriptor, int32_t landmark, double d) {
  double sum = 0;
  const auto& trees = model.forests[0].trees;
  for (const RegressionTree& tree : trees) {
    const int32_t leaf = tree.leaf_of(descriptor);
    const int32_t begin = tree.leaf_start[leaf], end = tree.leaf_start[leaf + 1];
    for (int32_t i = begin; i < end; ++i) {
      const uint16_t target = model.targets(tree.leaf_samples[i], landmark);
      if (target == target_missing) continue;
      const double bin = std::floor(target * double{model.reach} / target_steps / width + 1e-7);
      const double off = ((bin + 0.5) * width - d) / deviation;
      if (std::abs(off) > 4.1) continue;  // the Gaussian is cut at 8 bins
      sum += std::exp(-0.5 * off * off) * width / (deviation * std::sqrt(2 * std::numbers::pi)) /
             ((end - begin) * static_cast<double>(trees.size()));
    }
  }
  return sum * std::exp(-mu * d * d);
}

// 13 samples that go to all leaves.
RowMatrixf descriptors() {
  RowMatrixf rows = RowMatrixf::Zero(13, 96);
  for (int i = 0; i < 13; ++i)
    rows(i, 3) = 0.3F * static_cast<float>(i % 7), rows(i, 95) = i % 2 ? -3.0F : 1.0F;
  return rows;
}

}  // namespace

TEST_CASE("tables hold what the leaves remember") {
  const LandmarkModel model = small_model(Preset::default_preset);
  const RowMatrixf rows = descriptors();
  const VoteTables tables = LeafVotes(model, rows, {}).tables(0, 13, {});
  REQUIRE(tables.landmarks == 3);
  CHECK(tables.width == width);
  double largest = 0;
  for (int s = 0; s < 13; ++s)
    for (int r = 0; r < tables.rows; ++r)
      for (int l = 0; l < 3; ++l) {
        const double expected = naive(model, rows.row(s).data(), l, r * width);
        largest = std::max(largest, expected);
        CHECK(tables.of(s)[r * tables.stride() + l] == doctest::Approx(expected).epsilon(1e-4).scale(1e-3));
      }
  CHECK(largest > 0.01);
}

TEST_CASE("some samples at a time are the same as all at once, by any number of threads") {
  const LandmarkModel model = small_model(Preset::default_preset);
  const RowMatrixf rows = descriptors();
  Execution four;
  four.thread_count = 4;
  const VoteTables all = LeafVotes(model, rows, Execution().inner()).tables(0, 13, Execution().inner());
  const LeafVotes votes(model, rows, four);
  const VoteTables first = votes.tables(0, 9, four), rest = votes.tables(9, 4, four);
  std::vector<float> joined = first.weight;
  joined.insert(joined.end(), rest.weight.begin(), rest.weight.end());
  CHECK(joined == all.weight);
}
