// Confidence learned on placements whose outcome is known: it must mean what it says.
#include "landmarks/confidence.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"

using namespace focal;

namespace {

constexpr int32_t landmarks = 5;

// Placements that are right with a probability known from their evidence: the better the votes, the likelier.
struct Draw {
  JudgedPlacement judged;
  double probability;
};
std::vector<Draw> draw_placements(int32_t shapes, uint64_t seed) {
  Random random(seed);
  std::vector<Draw> result;
  for (int32_t s = 0; s < shapes; ++s)
    for (int32_t l = 0; l < landmarks; ++l) {
      Evidence evidence;
      evidence.vote_ratio = static_cast<float>(random.uniform());
      evidence.residual = static_cast<float>(2 * random.uniform());
      evidence.vote_level = 3;  // the same for all: the votes' level says nothing here
      const double p = 1 / (1 + std::exp(-(6 * evidence.vote_ratio - 2 * evidence.residual - 1)));
      const double error = random.uniform() < p ? 0.01 : 0.3;
      result.push_back({{l, s, evidence, error}, p});
    }
  return result;
}

Calibration learned(int32_t shapes) {
  std::vector<JudgedPlacement> judged;
  for (const Draw& draw : draw_placements(shapes, 1)) judged.push_back(draw.judged);
  return calibrate(judged, landmarks);
}

}  // namespace

TEST_CASE("confidence is the probability of being right, on placements not learned from") {
  const Calibration calibration = learned(400);
  double worst = 0;
  for (const Draw& draw : draw_placements(400, 2)) {
    const double confidence = confidence_of(calibration, draw.judged.landmark, draw.judged.evidence);
    worst = std::max(worst, std::abs(confidence - draw.probability));
  }
  CHECK(worst < 0.12);
}

TEST_CASE("a perfect record does not lead to certainty") {
  std::vector<JudgedPlacement> judged;
  for (int32_t s = 0; s < 10; ++s)
    for (int32_t l = 0; l < landmarks; ++l)
      judged.push_back({l, s, {.vote_ratio = 1, .residual = 0.1f, .vote_level = 2, .rival = 0.3f}, 0.01});
  const Calibration calibration = calibrate(judged, landmarks);
  const double good = confidence_of(calibration, 0, judged[0].evidence);
  CHECK(good > 0.9);
  CHECK(good < 0.999);
}

TEST_CASE("the expected error lies between that of right and that of wrong placements") {
  const Calibration calibration = learned(50);
  CHECK(expected_error_of(calibration, 1) == doctest::Approx(0.01));
  CHECK(expected_error_of(calibration, 0) == doctest::Approx(0.3));
  CHECK(expected_error_of(calibration, 0.5) == doctest::Approx(0.155));
}

TEST_CASE("a mesh with the evidence of the training meshes fits, one without does not") {
  const Calibration calibration = learned(50);
  const Evidence usual{.vote_ratio = 0.8f, .residual = 0.8f, .vote_level = 3, .rival = 0.5f};
  const Evidence foreign{.vote_ratio = 0.8f, .residual = 6, .vote_level = 0.05f, .rival = 1.5f};
  CHECK(category_fit_of(calibration, std::vector<Evidence>(landmarks, usual)) > 0.8);
  CHECK(category_fit_of(calibration, std::vector<Evidence>(landmarks, foreign)) < 0.2);
}
