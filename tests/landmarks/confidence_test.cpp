// Confidence learned on placements whose outcome is known: it must mean what it says.
#include "landmarks/confidence.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"

using namespace focal;

namespace {

constexpr int32_t landmarks = 5;

// Placements that are right with a probability known from their features: the better the votes, the likelier.
struct Draw {
  CalibrationSample samples;
  double probability;
};
std::vector<Draw> draw_placements(int32_t shapes, uint64_t seed) {
  Random random(seed);
  std::vector<Draw> result;
  for (int32_t s = 0; s < shapes; ++s)
    for (int32_t l = 0; l < landmarks; ++l) {
      PlacementFeatures features;
      features.vote_ratio = static_cast<float>(random.uniform());
      features.residual = static_cast<float>(2 * random.uniform());
      features.vote_level = 3;  // the same for all: the votes' level says nothing here
      const double p = 1 / (1 + std::exp(-(6 * features.vote_ratio - 2 * features.residual - 1)));
      const double error = random.uniform() < p ? 0.01 : 0.3;
      result.push_back({{l, s, features, error}, p});
    }
  return result;
}

Calibration learned(int32_t shapes) {
  std::vector<CalibrationSample> samples;
  for (const Draw& draw : draw_placements(shapes, 1)) samples.push_back(draw.samples);
  return calibrate(samples, landmarks);
}

}  // namespace

TEST_CASE("confidence is the probability of being right, on placements not learned from") {
  const Calibration calibration = learned(400);
  double worst = 0;
  for (const Draw& draw : draw_placements(400, 2)) {
    std::vector<PlacementFeatures> mesh(landmarks, draw.samples.features);
    const double confidence = estimate_confidence(calibration, mesh, 0).confidence[draw.samples.landmark];
    worst = std::max(worst, std::abs(confidence - draw.probability));
  }
  CHECK(worst < 0.12);
}

TEST_CASE("a perfect record does not lead to certainty") {
  std::vector<CalibrationSample> samples;
  for (int32_t s = 0; s < 10; ++s)
    for (int32_t l = 0; l < landmarks; ++l)
      samples.push_back(
          {l, s, {.vote_ratio = 1, .residual = 0.1f, .vote_level = 2, .runner_up = 0.3f}, 0.01});
  const Calibration calibration = calibrate(samples, landmarks);
  const double good =
      estimate_confidence(calibration, std::vector<PlacementFeatures>(landmarks, samples[0].features), 0)
          .confidence[0];
  CHECK(good > 0.9);
  CHECK(good < 0.999);
}

TEST_CASE("the expected error lies between that of right and that of wrong placements") {
  const Calibration calibration = learned(50);
  CHECK(expected_error_of(calibration, 1) == doctest::Approx(0.01));
  CHECK(expected_error_of(calibration, 0) == doctest::Approx(0.3));
  CHECK(expected_error_of(calibration, 0.5) == doctest::Approx(0.155));
}

TEST_CASE("a mesh with the features of the training meshes fits, one without does not") {
  const Calibration calibration = learned(50);
  const PlacementFeatures usual{.vote_ratio = 0.8f, .residual = 0.8f, .vote_level = 3, .runner_up = 0.5f};
  const PlacementFeatures foreign{.vote_ratio = 0.8f, .residual = 6, .vote_level = 0.05f, .runner_up = 1.5f};
  CHECK(estimate_confidence(calibration, std::vector<PlacementFeatures>(landmarks, usual), 0).category_fit >
        0.8);
  CHECK(estimate_confidence(calibration, std::vector<PlacementFeatures>(landmarks, foreign), 0).category_fit <
        0.2);
}

TEST_CASE("landmarks that were not there are told by what they had in common, and are never sure") {
  std::vector<CalibrationSample> samples;
  for (int32_t s = 0; s < 40; ++s)
    for (int32_t l = 0; l < landmarks; ++l) {
      const bool gone = l == s % landmarks && s % 2 == 0;
      const float sway = 0.1f * static_cast<float>((s * 7 + l) % 5);
      samples.push_back({l,
                         s,
                         {.vote_ratio = 1,
                          .residual = (gone ? 2 : 0.2f) + sway,
                          .vote_level = 2,
                          .border = gone ? 0.01f : 1},
                         0.01,
                         !gone});
    }
  const Calibration calibration = calibrate(samples, landmarks);
  std::vector<PlacementFeatures> mesh(landmarks, {.vote_ratio = 1, .residual = 0.3f, .vote_level = 2});
  mesh[2] = {.vote_ratio = 1, .residual = 2.2f, .vote_level = 2, .border = 0.01f};
  const ConfidenceEstimate estimate = estimate_confidence(calibration, mesh, 0);
  CHECK(estimate.absent[2] > 0.5);
  CHECK(estimate.confidence[2] < 0.5);
  CHECK(estimate.absent[1] < 0.1);
  CHECK(estimate.confidence[1] > 0.8);
}

TEST_CASE("a mesh that the training shapes cannot be mapped to does not fit") {
  std::vector<CalibrationSample> samples;
  for (int32_t s = 0; s < 10; ++s)
    for (int32_t l = 0; l < landmarks; ++l)
      samples.push_back({l,
                         s,
                         {.vote_ratio = 1, .residual = 0.2f, .vote_level = 2},
                         0.01,
                         true,
                         0.3f + 0.002f * static_cast<float>(s)});
  const Calibration calibration = calibrate(samples, landmarks);
  const std::vector<PlacementFeatures> mesh(landmarks, samples[0].features);
  CHECK(estimate_confidence(calibration, mesh, 0.31f).category_fit > 0.8);
  CHECK(estimate_confidence(calibration, mesh, 0.5f).category_fit < 0.1);
}

TEST_CASE("spoiled meshes are no measure of the category") {
  std::vector<CalibrationSample> samples;
  for (int32_t s = 0; s < 20; ++s)
    for (int32_t l = 0; l < landmarks; ++l) {
      const bool whole = s % 2 == 0;
      samples.push_back({l,
                         s,
                         {.vote_ratio = 1, .residual = whole ? 0.2f : 4, .vote_level = whole ? 2.0f : 0.2f},
                         0.01,
                         true,
                         whole ? 0.3f : 0.45f,
                         whole});
    }
  const Calibration calibration = calibrate(samples, landmarks);
  CHECK(estimate_confidence(calibration, std::vector<PlacementFeatures>(landmarks, samples[0].features), 0.3f)
            .category_fit > 0.8);
  CHECK(estimate_confidence(calibration,
                            std::vector<PlacementFeatures>(landmarks, samples[landmarks].features), 0.45f)
            .category_fit < 0.1);
}
