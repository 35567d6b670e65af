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
    std::vector<Evidence> mesh(landmarks, draw.judged.evidence);
    const double confidence = judge(calibration, mesh, 0).confidence[draw.judged.landmark];
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
  const double good =
      judge(calibration, std::vector<Evidence>(landmarks, judged[0].evidence), 0).confidence[0];
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
  CHECK(judge(calibration, std::vector<Evidence>(landmarks, usual), 0).category_fit > 0.8);
  CHECK(judge(calibration, std::vector<Evidence>(landmarks, foreign), 0).category_fit < 0.2);
}

TEST_CASE("landmarks that were not there are told by what they had in common, and are never sure") {
  std::vector<JudgedPlacement> judged;
  for (int32_t s = 0; s < 40; ++s)
    for (int32_t l = 0; l < landmarks; ++l) {
      const bool gone = l == s % landmarks && s % 2 == 0;
      const float sway = 0.1f * static_cast<float>((s * 7 + l) % 5);
      judged.push_back({l,
                        s,
                        {.vote_ratio = 1,
                         .residual = (gone ? 2 : 0.2f) + sway,
                         .vote_level = 2,
                         .border = gone ? 0.01f : 1},
                        0.01,
                        !gone});
    }
  const Calibration calibration = calibrate(judged, landmarks);
  std::vector<Evidence> mesh(landmarks, {.vote_ratio = 1, .residual = 0.3f, .vote_level = 2});
  mesh[2] = {.vote_ratio = 1, .residual = 2.2f, .vote_level = 2, .border = 0.01f};
  const Judgement judgement = judge(calibration, mesh, 0);
  CHECK(judgement.absent[2] > 0.5);
  CHECK(judgement.confidence[2] < 0.5);
  CHECK(judgement.absent[1] < 0.1);
  CHECK(judgement.confidence[1] > 0.8);
}

TEST_CASE("a mesh that the training shapes cannot be mapped to does not fit") {
  std::vector<JudgedPlacement> judged;
  for (int32_t s = 0; s < 10; ++s)
    for (int32_t l = 0; l < landmarks; ++l)
      judged.push_back({l,
                        s,
                        {.vote_ratio = 1, .residual = 0.2f, .vote_level = 2},
                        0.01,
                        true,
                        0.3f + 0.002f * static_cast<float>(s)});
  const Calibration calibration = calibrate(judged, landmarks);
  const std::vector<Evidence> mesh(landmarks, judged[0].evidence);
  CHECK(judge(calibration, mesh, 0.31f).category_fit > 0.8);
  CHECK(judge(calibration, mesh, 0.5f).category_fit < 0.1);
}

TEST_CASE("spoiled meshes are no measure of the category") {
  std::vector<JudgedPlacement> judged;
  for (int32_t s = 0; s < 20; ++s)
    for (int32_t l = 0; l < landmarks; ++l) {
      const bool whole = s % 2 == 0;
      judged.push_back({l,
                        s,
                        {.vote_ratio = 1, .residual = whole ? 0.2f : 4, .vote_level = whole ? 2.0f : 0.2f},
                        0.01,
                        true,
                        whole ? 0.3f : 0.45f,
                        whole});
    }
  const Calibration calibration = calibrate(judged, landmarks);
  CHECK(judge(calibration, std::vector<Evidence>(landmarks, judged[0].evidence), 0.3f).category_fit > 0.8);
  CHECK(judge(calibration, std::vector<Evidence>(landmarks, judged[landmarks].evidence), 0.45f).category_fit <
        0.1);
}
