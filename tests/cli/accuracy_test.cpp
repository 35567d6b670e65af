// The metrics against cases worked out by hand.
#include "evaluation/accuracy.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "evaluation/folds.h"

using namespace focal_cli;

namespace {

Outcome outcome(double error, double confidence, bool marked = true, bool said_absent = false) {
  return {"x", marked, said_absent, confidence, error, error / 100, {}};
}

MeshOutcome mesh_with(std::vector<Outcome> outcomes, double seconds = 1) {
  return {"m", 10, seconds, outcomes};
}

Outcome paired(bool swapped) {
  Outcome result = outcome(swapped ? 20 : 1, 0.5);
  result.swapped = swapped;
  return result;
}

}  // namespace

TEST_CASE("quantiles interpolate as NumPy's percentile does") {
  CHECK(quantile({4, 1, 3, 2}, 0.5) == doctest::Approx(2.5));
  CHECK(quantile({1, 2, 3, 4, 5}, 0.95) == doctest::Approx(4.8));
  CHECK(quantile({7}, 0.95) == 7);
  CHECK(std::isnan(quantile({}, 0.5)));
  CHECK(quantile({1, 2, std::numeric_limits<double>::infinity()}, 0.5) == 2);
}

TEST_CASE(
    "errors are in edges of the mesh and in sqrt(area); mirrors decide swaps; what is not marked has no "
    "error") {
  const std::map<std::string, Position> marks = {
      {"hand.L", {0, 0, 0}}, {"hand.R", {10, 0, 0}}, {"head", {0, 5, 0}}};
  const std::map<std::string, std::string> mirror = {
      {"hand.L", "hand.R"}, {"hand.R", "hand.L"}, {"tail.L", "tail.R"}, {"tail.R", "tail.L"}};
  const std::vector<Guess> guesses = {
      {"hand.L", Position{9, 0, 0}, 0.9, false},    // at the other hand: 18 edges off
      {"hand.R", Position{6.5, 0, 0}, 0.8, false},  // 7 edges off, and nearer to its own
      {"head", Position{3, 9, 0}, 0.7, false},
      {"tail.L", Position{1, 1, 1}, 0.1, true}};
  const auto judged = judge(guesses, marks, mirror, {0.5, 20});
  REQUIRE(judged.size() == 4);
  CHECK(judged[0].error_edges == doctest::Approx(18));
  CHECK(judged[0].error_root_area == doctest::Approx(0.45));
  CHECK(judged[0].swapped == true);
  CHECK(judged[1].error_edges == doctest::Approx(7));
  CHECK(judged[1].swapped == false);
  CHECK(judged[2].error_edges == doctest::Approx(10));
  CHECK_FALSE(judged[2].swapped.has_value());
  CHECK_FALSE(judged[3].marked);
  CHECK(judged[3].said_absent);
}

TEST_CASE("nearer to the mirror's mark but not 8 edges off is no swap") {
  const std::map<std::string, Position> marks = {{"L", {0, 0, 0}}, {"R", {10, 0, 0}}};
  const std::map<std::string, std::string> mirror = {{"L", "R"}, {"R", "L"}};
  CHECK(judge(std::vector<Guess>{{"L", Position{7.9, 0, 0}, 1, false}}, marks, mirror, {1, 1})[0].swapped ==
        false);
  CHECK(judge(std::vector<Guess>{{"L", Position{8.1, 0, 0}, 1, false}}, marks, mirror, {1, 1})[0].swapped ==
        true);
}

TEST_CASE("a landmark without any place has an infinite error and is neither lost nor called swapped") {
  const std::map<std::string, Position> marks = {{"L", {0, 0, 0}}, {"R", {10, 0, 0}}};
  const std::map<std::string, std::string> mirror = {{"L", "R"}, {"R", "L"}};
  const MeshOutcome mesh = mesh_with(judge(
      std::vector<Guess>{{"L", {}, 0, true}, {"R", Position{10, 0, 1}, 1, false}}, marks, mirror, {1, 1}));
  const Summary summary = summarise(std::vector{mesh});
  CHECK(std::isinf(summary.mean_edges));
  CHECK(summary.over_10_edges == 0.5);
  CHECK(summary.swap_rate == 0);
}

TEST_CASE("a mesh is flipped when more than a quarter of its pairs is swapped") {
  const MeshOutcome quarter = mesh_with({paired(true), paired(false), paired(false), paired(false)});
  const MeshOutcome more =
      mesh_with({paired(true), paired(true), paired(false), paired(false), outcome(1, 1)});
  CHECK(swapped_share(quarter) == 0.25);
  CHECK(is_flipped(quarter) == false);
  CHECK(is_flipped(more) == true);
  const Summary summary = summarise(std::vector{quarter, more});
  CHECK(summary.swap_rate == doctest::Approx(3.0 / 8));
  CHECK(summary.flipped_meshes == 1);
}

TEST_CASE("a set without pairs has no swaps and no flips, not zero of them") {
  const Summary summary = summarise(std::vector{mesh_with({outcome(1, 1)})});
  CHECK(std::isnan(summary.swap_rate));
  CHECK_FALSE(summary.flipped_meshes.has_value());
  CHECK_FALSE(is_flipped(mesh_with({outcome(1, 1)})).has_value());
}

TEST_CASE("totals run over all marks of all meshes") {
  const std::vector meshes = {mesh_with({outcome(1, 1), outcome(3, 1)}, 2), mesh_with({outcome(14, 1)}, 4)};
  const Summary summary = summarise(meshes);
  CHECK(summary.marks == 3);
  CHECK(summary.mean_edges == doctest::Approx(6));
  CHECK(summary.median_edges == doctest::Approx(3));
  CHECK(summary.p95_edges == doctest::Approx(12.9));
  CHECK(summary.mean_root_area_x100 == doctest::Approx(6));
  CHECK(summary.over_10_edges == doctest::Approx(1.0 / 3));
  CHECK(summary.within_4_edges == doctest::Approx(2.0 / 3));
  CHECK(summary.seconds_median == doctest::Approx(3));
}

TEST_CASE("absent: precision of what is called absent, recall of what is absent") {
  const Summary summary = summarise(std::vector{
      mesh_with({outcome(1, 1, true, false), outcome(1, 0, true, true), outcome(0, 0, false, true),
                 outcome(0, 0, false, false), outcome(0, 0, false, false)})});
  CHECK(summary.absent_precision == doctest::Approx(0.5));
  CHECK(summary.absent_recall == doctest::Approx(1.0 / 3));
  const Summary all_there = summarise(std::vector{mesh_with({outcome(1, 1)})});
  CHECK(std::isnan(all_there.absent_precision));
  CHECK(std::isnan(all_there.absent_recall));
}

TEST_CASE("calibration: bins, expected error and AUROC") {
  // Bin 9: confidences 0.9 and 1.0 (mean 0.95), one of two right. Bin 2: confidence 0.25, right. Bin 0: 0.05,
  // wrong.
  const Summary summary = summarise(
      std::vector{mesh_with({outcome(4, 0.9), outcome(4.1, 1.0), outcome(0, 0.25), outcome(50, 0.05)})});
  const Calibration& calibration = summary.calibration;
  REQUIRE(calibration.bins.size() == 10);
  CHECK(calibration.bins[9].count == 2);
  CHECK(calibration.bins[9].confidence == doctest::Approx(0.95));
  CHECK(calibration.bins[9].accuracy == doctest::Approx(0.5));
  CHECK(calibration.bins[2].count == 1);
  CHECK(std::isnan(calibration.bins[5].accuracy));
  CHECK(calibration.expected_error == doctest::Approx((2 * 0.45 + 0.75 + 0.05) / 4));
  CHECK(calibration.sure_count == 2);
  CHECK(calibration.sure_right == doctest::Approx(0.5));
  // Right 0.9 and 0.25 against wrong 1.0 and 0.05: two of the four comparisons are won.
  CHECK(calibration.auroc == doctest::Approx(0.5));
}

TEST_CASE("AUROC counts ties half and is not defined when all are right") {
  const auto auroc = [](std::vector<Outcome> outcomes) {
    return summarise(std::vector{mesh_with(std::move(outcomes))}).calibration.auroc;
  };
  CHECK(auroc({outcome(1, 0.5), outcome(9, 0.5)}) == doctest::Approx(0.5));
  CHECK(auroc({outcome(1, 0.5), outcome(9, 0.5), outcome(1, 0.6)}) == doctest::Approx(0.75));
  CHECK(auroc({outcome(1, 0.9), outcome(9, 0.1)}) == doctest::Approx(1));
  CHECK(std::isnan(auroc({outcome(1, 0.9), outcome(2, 0.1)})));
}

TEST_CASE("confidence in a landmark that the mesh lacks counts as wrong") {
  const Summary summary = summarise(std::vector{mesh_with({outcome(0, 0.95, false)})});
  CHECK(summary.calibration.bins[9].accuracy == 0);
  CHECK(summary.calibration.expected_error == doctest::Approx(0.95));
  CHECK(std::isnan(summary.mean_edges));
}

TEST_CASE("no confidence of 0.9 or more: the share of such that is right is not defined") {
  const Summary summary = summarise(std::vector{mesh_with({outcome(1, 0.89), outcome(20, 0.1)})});
  CHECK(summary.calibration.sure_count == 0);
  CHECK(std::isnan(summary.calibration.sure_right));
}

TEST_CASE("landmarks are summed up one by one") {
  Outcome a = outcome(2, 1), b = outcome(12, 1);
  a.name = "a", b.name = "b";
  Outcome gone = outcome(0, 0, false);
  gone.name = "a";
  const auto rows = summarise_landmarks(std::vector{mesh_with({b, a}), mesh_with({b, gone})});
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].name == "b");
  CHECK(rows[0].marks == 2);
  CHECK(rows[0].over_10_edges == 1);
  CHECK(rows[1].marks == 1);
  CHECK(rows[1].mean_edges == 2);
  CHECK(rows[1].p95_edges == 2);
  CHECK(rows[1].within_4_edges == 1);
  CHECK(rows[0].within_4_edges == 0);
}

TEST_CASE("folds are neighbours, of sizes that differ by one at most, none empty") {
  CHECK(folds_of(5, 5) == std::vector<size_t>{0, 1, 2, 3, 4});
  CHECK(folds_of(7, 3) == std::vector<size_t>{0, 0, 0, 1, 1, 2, 2});
  for (size_t count = 2; count < 40; ++count) {
    for (size_t folds = 2; folds <= count; ++folds) {
      std::vector<size_t> sizes(folds);
      for (const size_t fold : folds_of(count, folds)) ++sizes.at(fold);
      for (const size_t size : sizes) CHECK((size == count / folds || size == (count + folds - 1) / folds));
    }
  }
}
