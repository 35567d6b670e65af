#include "landmarks/confidence.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace focal {
namespace {

constexpr int32_t features = Calibration::feature_count;

double logistic(double x) { return 1 / (1 + std::exp(-x)); }

// Ridge-regularised logistic regression by Newton's method. Each judged placement also counts as weakly wrong and weakly
// right (Platt 1999), so that a perfect training set does not lead to certainty.
void fit_logistic(const std::vector<std::array<float, features>>& x, const std::vector<double>& target,
                  float* weight) {
  constexpr double ridge = 1.0;
  Vector w = Vector::Zero(features + 1);
  for (int step = 0; step < 50; ++step) {
    Matrix hessian = ridge * Matrix::Identity(features + 1, features + 1);
    hessian(features, features) = 1e-3;  // the bias is free
    Vector gradient = -(hessian * w);
    for (size_t i = 0; i < x.size(); ++i) {
      Vector row(features + 1);
      for (int f = 0; f < features; ++f) row[f] = x[i][f];
      row[features] = 1;
      const double p = logistic(w.dot(row));
      gradient += (target[i] - p) * row;
      hessian += p * (1 - p) * row * row.transpose();
    }
    const Vector move = hessian.ldlt().solve(gradient);
    w += move;
    if (move.norm() < 1e-8) break;
  }
  for (int f = 0; f <= features; ++f) weight[f] = static_cast<float>(w[f]);
}

double evidence_sum(const Calibration& calibration, int32_t landmark, const Evidence& evidence) {
  const auto x = confidence_features(evidence, calibration.typical_vote[landmark]);
  double sum = calibration.weight[features];
  for (int f = 0; f < features; ++f) sum += calibration.weight[f] * x[f];
  return sum;
}

// The evidence for the mesh as a whole: the mean over its landmarks of how far they fit, each within bounds so that one
// lost landmark does not decide.
double mesh_evidence(const Calibration& calibration, const std::vector<Evidence>& evidence) {
  double sum = 0;
  for (size_t l = 0; l < evidence.size(); ++l) {
    const auto x = confidence_features(evidence[l], calibration.typical_vote[l]);
    sum += std::clamp<double>(x[2] - x[1], -6, 6);
  }
  return sum / static_cast<double>(std::max<size_t>(evidence.size(), 1));
}

}  // namespace

std::array<float, features> confidence_features(const Evidence& evidence, float typical_vote) {
  const float level = typical_vote > 0 ? evidence.vote_level / typical_vote : 1;
  return {evidence.vote_ratio, evidence.residual, std::log(std::clamp(level, 1e-3f, 1e3f)),
          std::clamp(evidence.rival, 0.0f, 2.0f)};
}

Calibration calibrate(const std::vector<JudgedPlacement>& judged, int32_t landmarks) {
  Calibration result;
  result.typical_vote.assign(landmarks, 0);
  std::vector<int32_t> count(landmarks, 0);
  double error[2] = {}, number[2] = {};
  for (const auto& j : judged) {
    const bool near = j.error < near_radius;
    error[near] += j.error, ++number[near];
    if (near) result.typical_vote[j.landmark] += j.evidence.vote_level, ++count[j.landmark];
  }
  for (int32_t l = 0; l < landmarks; ++l)
    if (count[l]) result.typical_vote[l] /= static_cast<float>(count[l]);
  if (number[1] > 0) result.near_error = static_cast<float>(error[1] / number[1]);
  if (number[0] > 0) result.far_error = static_cast<float>(error[0] / number[0]);
  std::vector<std::array<float, features>> x;
  std::vector<double> target;
  const double right = (number[1] + 1) / (number[1] + 2), wrong = 1 / (number[0] + 2);
  for (const auto& j : judged) {
    x.push_back(confidence_features(j.evidence, result.typical_vote[j.landmark]));
    target.push_back(j.error < near_radius ? right : wrong);
  }
  if (!x.empty()) fit_logistic(x, target, result.weight);

  // Category fit: 0.9 at the mean of the training meshes' evidence, 0.5 three deviations below.
  std::vector<double> meshes;
  for (size_t i = 0; i < judged.size();) {
    std::vector<Evidence> evidence(landmarks);
    Calibration own = result;
    size_t k = i;
    std::vector<Evidence> present;
    std::vector<float> typical;
    for (; k < judged.size() && judged[k].shape == judged[i].shape; ++k) {
      present.push_back(judged[k].evidence);
      typical.push_back(result.typical_vote[judged[k].landmark]);
    }
    own.typical_vote = typical;
    meshes.push_back(mesh_evidence(own, present));
    i = k;
  }
  double mean = 0, square = 0;
  for (const double m : meshes) mean += m / static_cast<double>(meshes.size());
  for (const double m : meshes) square += (m - mean) * (m - mean) / static_cast<double>(meshes.size());
  const double spread = std::max(std::sqrt(square), 0.1);
  result.fit_centre = static_cast<float>(mean - 3 * spread);
  result.fit_scale = static_cast<float>(std::log(9.0) / (3 * spread));
  return result;
}

double confidence_of(const Calibration& calibration, int32_t landmark, const Evidence& evidence) {
  return logistic(evidence_sum(calibration, landmark, evidence));
}

double expected_error_of(const Calibration& calibration, double confidence) {
  return confidence * calibration.near_error + (1 - confidence) * calibration.far_error;
}

double category_fit_of(const Calibration& calibration, const std::vector<Evidence>& evidence) {
  return logistic(calibration.fit_scale * (mesh_evidence(calibration, evidence) - calibration.fit_centre));
}

}  // namespace focal
