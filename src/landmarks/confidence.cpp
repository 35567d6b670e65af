#include "landmarks/confidence.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace focal {
namespace {

constexpr int32_t feature_count = Calibration::feature_count;

using Features = std::array<float, feature_count>;

double logistic(double x) { return 1 / (1 + std::exp(-x)); }

// Ridge-regularised logistic regression by Newton's method. Each sample also counts slightly as its opposite
// (Platt 1999), so that a training set without errors does not lead to certainty.
void fit_logistic(const std::vector<Features>& x, const std::vector<double>& target, float* weight) {
  constexpr double ridge = 1.0;
  Vector w = Vector::Zero(feature_count + 1);
  for (int step = 0; step < 50; ++step) {
    Matrix hessian = ridge * Matrix::Identity(feature_count + 1, feature_count + 1);
    hessian(feature_count, feature_count) = 1e-3;  // the bias is not regularised
    Vector gradient = -(hessian * w);
    for (size_t i = 0; i < x.size(); ++i) {
      Vector row(feature_count + 1);
      for (int f = 0; f < feature_count; ++f) row[f] = x[i][f];
      row[feature_count] = 1;
      const double p = logistic(w.dot(row));
      gradient += (target[i] - p) * row;
      hessian += p * (1 - p) * row * row.transpose();
    }
    const Vector move = hessian.ldlt().solve(gradient);
    w += move;
    if (move.norm() < 1e-8) break;
  }
  for (int f = 0; f <= feature_count; ++f) weight[f] = static_cast<float>(w[f]);
}

float log_level(const Calibration& calibration, int32_t landmark, const PlacementFeatures& features) {
  const float typical = calibration.typical_vote[landmark];
  return typical > 0 ? std::log(std::clamp(features.vote_level / typical, 1e-3f, 1e3f)) : 0;
}

// Features of the mesh as a whole: the mean over its landmarks, each clamped so that one lost landmark does
// not decide, and the similarity found by the maps.
double mean_of(const Calibration& calibration, const std::vector<int32_t>& landmark,
               const std::vector<PlacementFeatures>& features, float map_residual) {
  // A tenth more residual: two units, as much as a clear drop of all votes.
  constexpr double residual_weight = 20;
  double sum = 0;
  for (size_t i = 0; i < features.size(); ++i)
    sum += std::clamp(log_level(calibration, landmark[i], features[i]) - features[i].residual, -6.0f, 6.0f);
  sum /= static_cast<double>(std::max<size_t>(features.size(), 1));
  if (calibration.typical_residual > 0 && map_residual > 0)
    sum -= residual_weight * std::log(map_residual / calibration.typical_residual);
  return sum;
}

double fit_odds(const Calibration& calibration, double mesh) {
  return calibration.fit_scale * (mesh - calibration.fit_centre);
}

float length_feature(float length) { return std::log(std::clamp(length, 0.0f, 0.3f) + 0.005f); }

Features features_of(const Calibration& calibration, int32_t landmark, const PlacementFeatures& e,
                     double mesh, bool mapped) {
  return {e.vote_ratio,
          e.residual,
          log_level(calibration, landmark, e),
          std::clamp(e.runner_up, 0.0f, 2.0f),
          mapped ? length_feature(e.spread) : calibration.typical_length[0],
          mapped ? length_feature(e.gap) : calibration.typical_length[1],
          std::exp(-std::clamp(e.border, 0.0f, 1.0f) / 0.05f),
          static_cast<float>(std::clamp(mesh, -12.0, 4.0) / 4),
          e.left_out ? 1.0f : 0.0f};
}

double weighted(const float* weight, const Features& x) {
  double sum = weight[feature_count];
  for (int f = 0; f < feature_count; ++f) sum += weight[f] * x[f];
  return sum;
}

// The placements of one mesh: [begin, end) of the list.
struct MeshRange {
  size_t begin, end;
};
std::vector<MeshRange> meshes_of(const std::vector<CalibrationSample>& samples) {
  std::vector<MeshRange> result;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (i == 0 || samples[i].mesh != samples[i - 1].mesh) result.push_back({i, i});
    result.back().end = i + 1;
  }
  return result;
}

double mesh_mean(const Calibration& calibration, const std::vector<CalibrationSample>& samples,
                 const MeshRange& mesh) {
  std::vector<int32_t> landmark;
  std::vector<PlacementFeatures> features;
  for (size_t i = mesh.begin; i < mesh.end; ++i)
    landmark.push_back(samples[i].landmark), features.push_back(samples[i].features);
  return mean_of(calibration, landmark, features, samples[mesh.begin].map_residual);
}

// Learns typical votes, errors and residual.
void learn_typical(const std::vector<CalibrationSample>& samples, Calibration& result) {
  std::vector<int32_t> count(result.typical_vote.size(), 0);
  double error[2] = {}, number[2] = {}, residual = 0, whole = 0;
  for (const auto& j : samples) {
    if (j.is_whole) residual += j.map_residual, ++whole;
    result.typical_length[0] += length_feature(j.features.spread) / static_cast<float>(samples.size());
    result.typical_length[1] += length_feature(j.features.gap) / static_cast<float>(samples.size());
    if (!j.is_marked) continue;
    const bool near = j.error < near_radius;
    error[near] += j.error, ++number[near];
    if (near) result.typical_vote[j.landmark] += j.features.vote_level, ++count[j.landmark];
  }
  for (size_t l = 0; l < count.size(); ++l)
    if (count[l]) result.typical_vote[l] /= static_cast<float>(count[l]);
  if (number[1] > 0) result.near_error = static_cast<float>(error[1] / number[1]);
  if (number[0] > 0) result.far_error = static_cast<float>(error[0] / number[0]);
  result.typical_residual = static_cast<float>(residual / std::max(whole, 1.0));
}

// Learns the category fit: 0.9 at the mean of the features of uncorrupted training meshes, 0.5 three
// deviations below.
void learn_fit(const std::vector<CalibrationSample>& samples, const std::vector<MeshRange>& meshes,
               Calibration& result) {
  double mean = 0, square = 0;
  std::vector<double> values;
  for (const auto& mesh : meshes)
    if (samples[mesh.begin].is_whole) values.push_back(mesh_mean(result, samples, mesh));
  for (const double m : values) mean += m / static_cast<double>(values.size());
  for (const double m : values) square += (m - mean) * (m - mean) / static_cast<double>(values.size());
  const double spread = std::max(std::sqrt(square), 0.1);
  result.fit_centre = static_cast<float>(mean - 3 * spread);
  result.fit_scale = static_cast<float>(std::log(9.0) / (3 * spread));
}

// Probabilities in which each example counts slightly as its opposite (Platt 1999).
std::vector<double> softened(const std::vector<char>& is_true) {
  const auto yes = static_cast<double>(std::count(is_true.begin(), is_true.end(), 1));
  const double no = static_cast<double>(is_true.size()) - yes;
  std::vector<double> result;
  for (const char truth : is_true) result.push_back(truth ? (yes + 1) / (yes + 2) : 1 / (no + 2));
  return result;
}

// The threshold for absence with the best F1 on the samples: absent samples are few, so that even clear ones
// stay below a probability of a half. Infinity when no sample is absent.
double absence_threshold(const std::vector<double>& score, const std::vector<char>& is_absent) {
  std::vector<size_t> order(score.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return score[a] > score[b]; });
  const auto all = static_cast<double>(std::count(is_absent.begin(), is_absent.end(), 1));
  double found = 0, best = 0, threshold = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < order.size(); ++i) {
    found += is_absent[order[i]];
    const double f1 = 2 * found / (static_cast<double>(i + 1) + all);
    if (f1 <= best) continue;
    best = f1;
    threshold = i + 1 < order.size() ? (score[order[i]] + score[order[i + 1]]) / 2 : score[order[i]];
  }
  return threshold;
}

}  // namespace

Calibration calibrate(const std::vector<CalibrationSample>& samples, int32_t landmarks) {
  Calibration result;
  result.typical_vote.assign(landmarks, 0);
  if (samples.empty()) return result;
  learn_typical(samples, result);
  const auto meshes = meshes_of(samples);
  learn_fit(samples, meshes, result);
  std::vector<Features> x;
  std::vector<char> is_right, is_absent;
  for (const auto& mesh : meshes) {
    const double mean = mesh_mean(result, samples, mesh);
    for (size_t i = mesh.begin; i < mesh.end; ++i) {
      x.push_back(
          features_of(result, samples[i].landmark, samples[i].features, mean, samples[i].map_residual > 0));
      is_right.push_back(samples[i].is_marked && samples[i].error < near_radius);
      is_absent.push_back(!samples[i].is_marked);
    }
  }
  fit_logistic(x, softened(is_right), result.weight);
  fit_logistic(x, softened(is_absent), result.absent_weight);
  std::vector<double> score;
  for (const Features& f : x) score.push_back(weighted(result.absent_weight, f));
  if (const double threshold = absence_threshold(score, is_absent); std::isfinite(threshold))
    // So that the threshold is at a half.
    result.absent_weight[feature_count] -= static_cast<float>(threshold);
  return result;
}

ConfidenceEstimate estimate_confidence(const Calibration& calibration,
                                       const std::vector<PlacementFeatures>& features, float map_residual) {
  std::vector<int32_t> all(features.size());
  std::iota(all.begin(), all.end(), 0);
  const double mesh = mean_of(calibration, all, features, map_residual);
  const double odds = fit_odds(calibration, mesh);
  // All training shapes belong to the category; foreign ones were never seen, so the fit can only lower the
  // confidence.
  const double gate = logistic(odds + 6);  // far below the odds of corrupted meshes of the category
  ConfidenceEstimate result{logistic(odds), {}, {}};
  for (const int32_t l : all) {
    const Features x = features_of(calibration, l, features[l], mesh, map_residual > 0);
    result.confidence.push_back(gate * logistic(weighted(calibration.weight, x)));
    result.absent.push_back(logistic(weighted(calibration.absent_weight, x)));
  }
  return result;
}

double expected_error_of(const Calibration& calibration, double confidence) {
  return confidence * calibration.near_error + (1 - confidence) * calibration.far_error;
}

}  // namespace focal
