// How well landmarks were found. See accuracy.h.
#include "evaluation/accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace focal_cli {
namespace {

constexpr double not_defined = std::numeric_limits<double>::quiet_NaN();

double ratio(double part, double whole) { return whole > 0 ? part / whole : not_defined; }

double distance(const std::optional<Position>& guess, const Position& mark) {
  if (!guess) return std::numeric_limits<double>::infinity();
  return std::hypot((*guess)[0] - mark[0], (*guess)[1] - mark[1], (*guess)[2] - mark[2]);
}

std::vector<Outcome> all_outcomes(std::span<const MeshOutcome> meshes) {
  std::vector<Outcome> all;
  for (const MeshOutcome& mesh : meshes) all.insert(all.end(), mesh.outcomes.begin(), mesh.outcomes.end());
  return all;
}

// A landmark the mesh lacks cannot be right, however sure the detector is of it.
bool is_right(const Outcome& outcome) { return outcome.marked && outcome.error_edges <= right_edges; }

// Mann-Whitney: the sum of the right ones' ranks by confidence, ties sharing their mean rank.
double auroc_of(std::vector<Outcome> outcomes) {
  std::sort(outcomes.begin(), outcomes.end(),
            [](const Outcome& a, const Outcome& b) { return a.confidence < b.confidence; });
  double rank_sum = 0, right = 0;
  for (size_t begin = 0, end; begin < outcomes.size(); begin = end) {
    end = begin;
    while (end < outcomes.size() && outcomes[end].confidence == outcomes[begin].confidence) ++end;
    const double mean_rank = (static_cast<double>(begin + 1) + static_cast<double>(end)) / 2;
    const auto first = outcomes.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = outcomes.begin() + static_cast<std::ptrdiff_t>(end);
    const auto right_here = static_cast<double>(std::count_if(first, last, is_right));
    rank_sum += right_here * mean_rank;
    right += right_here;
  }
  const double wrong = static_cast<double>(outcomes.size()) - right;
  return ratio(rank_sum - right * (right + 1) / 2, right * wrong);
}

Calibration calibrate(const std::vector<Outcome>& outcomes) {
  Calibration result{0, auroc_of(outcomes), std::vector<CalibrationBin>(calibration_bins), 0, 0};
  for (const Outcome& outcome : outcomes) {
    const auto index = static_cast<size_t>(std::clamp(outcome.confidence, 0.0, 1.0) * calibration_bins);
    CalibrationBin& bin = result.bins[std::min(index, calibration_bins - 1)];
    bin.count += 1;
    bin.confidence += outcome.confidence;
    bin.accuracy += is_right(outcome);
    const bool sure = outcome.confidence >= sure_confidence;
    result.sure_count += sure;
    result.sure_right += sure && is_right(outcome);
  }
  result.sure_right = ratio(result.sure_right, static_cast<double>(result.sure_count));
  for (size_t i = 0; i < calibration_bins; ++i) {
    CalibrationBin& bin = result.bins[i];
    bin.from = static_cast<double>(i) / calibration_bins;
    bin.to = static_cast<double>(i + 1) / calibration_bins;
    result.expected_error +=
        std::abs(bin.accuracy - bin.confidence);  // both still sums: share x difference x n
    bin.confidence = ratio(bin.confidence, static_cast<double>(bin.count));
    bin.accuracy = ratio(bin.accuracy, static_cast<double>(bin.count));
  }
  result.expected_error = ratio(result.expected_error, static_cast<double>(outcomes.size()));
  return result;
}

double share_over(std::span<const double> values, double limit) {
  const auto over = std::count_if(values.begin(), values.end(), [&](double x) { return x > limit; });
  return ratio(static_cast<double>(over), static_cast<double>(values.size()));
}

void add_absences(const std::vector<Outcome>& outcomes, Summary& summary) {
  double said = 0, truly = 0, both = 0;
  for (const Outcome& outcome : outcomes) {
    said += outcome.said_absent;
    truly += !outcome.marked;
    both += outcome.said_absent && !outcome.marked;
  }
  summary.absent_precision = ratio(both, said);
  summary.absent_recall = ratio(both, truly);
}

void add_swaps(std::span<const MeshOutcome> meshes, Summary& summary) {
  double swapped = 0, paired = 0;
  for (const MeshOutcome& mesh : meshes) {
    for (const Outcome& outcome : mesh.outcomes) {
      paired += outcome.swapped.has_value();
      swapped += outcome.swapped.value_or(false);
    }
    if (const auto flipped = is_flipped(mesh)) {
      summary.flipped_meshes = summary.flipped_meshes.value_or(0) + *flipped;
    }
  }
  summary.swap_rate = ratio(swapped, paired);
}

}  // namespace

double mean(std::span<const double> values) {
  return ratio(std::accumulate(values.begin(), values.end(), 0.0), static_cast<double>(values.size()));
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return not_defined;
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<size_t>(place);
  const double weight = place - static_cast<double>(below);
  if (weight == 0) return values[below];  // 0 x infinity would be undefined
  return (1 - weight) * values[below] + weight * values[below + 1];
}

std::vector<Outcome> judge(std::span<const Guess> guesses, const std::map<std::string, Position>& marks,
                           const std::map<std::string, std::string>& mirror, const MeshScale& scale) {
  std::vector<Outcome> outcomes;
  for (const Guess& guess : guesses) {
    Outcome outcome{guess.name, false, guess.absent, guess.confidence, 0, 0, {}};
    if (const auto mark = marks.find(guess.name); mark != marks.end()) {
      const double error = distance(guess.position, mark->second);
      outcome.marked = true;
      outcome.error_edges = error / scale.mean_edge;
      outcome.error_root_area = error / scale.root_area;
      const auto pair = mirror.find(guess.name);
      const auto other = pair == mirror.end() ? marks.end() : marks.find(pair->second);
      if (other != marks.end()) {
        outcome.swapped = distance(guess.position, other->second) < error && outcome.error_edges > swap_edges;
      }
    }
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

double swapped_share(const MeshOutcome& mesh) {
  double swapped = 0, paired = 0;
  for (const Outcome& outcome : mesh.outcomes) {
    paired += outcome.swapped.has_value();
    swapped += outcome.swapped.value_or(false);
  }
  return ratio(swapped, paired);
}

std::optional<bool> is_flipped(const MeshOutcome& mesh) {
  const double share = swapped_share(mesh);
  if (std::isnan(share)) return {};
  return share > flipped_share;
}

Summary summarise(std::span<const MeshOutcome> meshes) {
  std::vector<double> edges, root_area, seconds, fits;
  for (const MeshOutcome& mesh : meshes) {
    seconds.push_back(mesh.seconds);
    fits.push_back(mesh.category_fit);
    for (const Outcome& outcome : mesh.outcomes) {
      if (!outcome.marked) continue;
      edges.push_back(outcome.error_edges);
      root_area.push_back(outcome.error_root_area);
    }
  }
  Summary summary;
  summary.marks = edges.size();
  summary.mean_edges = mean(edges);
  summary.median_edges = quantile(edges, 0.5);
  summary.p95_edges = quantile(edges, 0.95);
  summary.mean_root_area_x100 = 100 * mean(root_area);
  summary.within_4_edges = 1 - share_over(edges, right_edges);
  summary.over_10_edges = share_over(edges, far_edges);
  summary.category_fit_median = quantile(fits, 0.5);
  summary.seconds_median = quantile(seconds, 0.5);
  const std::vector<Outcome> outcomes = all_outcomes(meshes);
  add_swaps(meshes, summary);
  add_absences(outcomes, summary);
  summary.calibration = calibrate(outcomes);
  return summary;
}

std::vector<LandmarkSummary> summarise_landmarks(std::span<const MeshOutcome> meshes) {
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> errors;
  for (const Outcome& outcome : all_outcomes(meshes)) {
    if (!errors.contains(outcome.name)) names.push_back(outcome.name);
    std::vector<double>& mine = errors[outcome.name];
    if (outcome.marked) mine.push_back(outcome.error_edges);
  }
  std::vector<LandmarkSummary> rows;
  for (const std::string& name : names) {
    const std::vector<double>& mine = errors[name];
    rows.push_back({name, mine.size(), mean(mine), quantile(mine, 0.5), quantile(mine, 0.95),
                    quantile(mine, 1), 1 - share_over(mine, right_edges), share_over(mine, far_edges)});
  }
  return rows;
}

}  // namespace focal_cli
