#include "judge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <numeric>

#include "base/error.h"
#include "base/stopwatch.h"
#include "mesh/fill_holes.h"

namespace focal_robustness {
namespace {

using namespace focal;

Vector3 mapped(const Matrix4& map, const Vector3& p) {
  return map.topLeftCorner<3, 3>() * p + map.topRightCorner<3, 1>();
}

void compare_with_clean(const std::vector<DetectedLandmark>& found,
                        const std::vector<DetectedLandmark>& clean, const Spoiled& spoiled, double edge,
                        CaseResult& result) {
  for (size_t l = 0; l < found.size(); ++l) {
    const Vector3 there = mapped(spoiled.map, clean[l].position);
    result.deviation =
        std::max(result.deviation, (found[l].position - there).norm() / (edge * spoiled.scale));
    if (found[l].status != clean[l].status) result.deviation = std::numeric_limits<double>::infinity();
  }
}

double nearest_border(const TriangleMesh& mesh, const std::vector<std::vector<int32_t>>& loops,
                      const Vector3& place) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& loop : loops)
    for (const int32_t v : loop)
      nearest = std::min(nearest, (mesh.positions.row(v).transpose() - place).norm());
  return nearest;
}

void judge(const Case& which, const Shape& shape, const Spoiled& spoiled,
           const std::vector<DetectedLandmark>& found, double edge, CaseResult& result) {
  const auto border =
      which.missing ? border_loops(spoiled.corrupted.mesh) : std::vector<std::vector<int32_t>>{};
  for (size_t l = 0; l < found.size(); ++l) {
    if (!shape.marks[l]) continue;
    const auto& truth = spoiled.corrupted.marks[l];
    if (!truth && !which.missing) {
      ++result.lost_in_holes;  // a place the size of a hole: neither here nor absent
      continue;
    }
    const bool said_absent = found[l].status == LandmarkStatus::absent;
    result.said_absent += said_absent, result.truly_absent += !truth;
    result.both_absent += said_absent && !truth;
    (truth ? result.confidence_here : result.confidence_gone).push_back(found[l].confidence);
    (truth ? result.border_here : result.border_gone)
        .push_back(nearest_border(spoiled.corrupted.mesh, border, found[l].position) / edge);
    result.outcomes.push_back({found[l].confidence, nullptr});
    if (!truth) continue;
    result.errors.push_back((found[l].position - position_of(spoiled.corrupted.mesh, *truth)).norm() /
                            (edge * spoiled.scale));
    result.outcomes.back()[1] = result.errors.back();
  }
}

double ratio(double part, double whole) { return whole > 0 ? part / whole : NAN; }

}  // namespace

double CaseResult::mean() const {
  return ratio(std::accumulate(errors.begin(), errors.end(), 0.0), static_cast<double>(errors.size()));
}

double CaseResult::median() const {
  std::vector<double> sorted = errors;
  std::sort(sorted.begin(), sorted.end());
  return sorted.empty() ? NAN : sorted[sorted.size() / 2];
}

double CaseResult::share_over(double limit) const {
  const auto over = std::count_if(errors.begin(), errors.end(), [&](double e) { return e > limit; });
  return ratio(static_cast<double>(over), static_cast<double>(errors.size()));
}

double CaseResult::separation(const std::vector<double>& here, const std::vector<double>& gone) {
  double lower = 0;
  for (const double h : here)
    for (const double g : gone) lower += g < h ? 1 : g == h ? 0.5 : 0;
  return ratio(lower, static_cast<double>(here.size() * gone.size()));
}

CaseResult run_case(const Case& which, const Shapes& shapes,
                    const std::shared_ptr<const LandmarkModel>& model, uint64_t seed, CleanAnswers& clean) {
  CaseResult result;
  result.name = which.name, result.wanted = which.wanted;
  result.missing = which.missing, result.similarity = which.similarity;
  const bool is_clean = clean.size() < shapes.judged.size();
  for (size_t s = 0; s < shapes.judged.size(); ++s) {
    const Shape& shape = shapes.judged[s];
    Random random(seed, s);
    const Spoiled spoiled = which.spoil(shape, random);
    const double edge = mean_edge_length(shape.mesh);
    Stopwatch watch;
    try {
      const auto mesh =
          std::make_shared<const PreparedMesh>(prepare(in_single_precision(spoiled.corrupted.mesh)));
      DetectParams how;
      how.keep_votes = false;
      const auto found = detect(model, mesh, how, {}).landmarks;
      judge(which, shape, spoiled, found, edge, result);
      if (is_clean) clean.push_back(found);
      if (which.similarity) compare_with_clean(found, clean[s], spoiled, edge, result);
    } catch (const Error& error) {
      std::cerr << which.name << ", " << shape.name << ": " << error.what() << '\n';
      if (is_clean) throw;
      ++result.failed;
    }
    result.seconds += watch.lap();
  }
  return result;
}

void print_table(const std::vector<CaseResult>& results) {
  std::printf("%-24s %-20s %6s %7s %7s %7s %6s %9s %9s %7s %9s %9s %9s\n", "case", "wanted", "marks", "mean",
              "+clean", "median", "over10", "absent P", "absent R", "failed", "by conf", "by border",
              "deviation");
  const double clean = results.front().mean();
  for (const CaseResult& r : results) {
    std::printf("%-24s %-20s %6zu %7.2f %+7.2f %7.2f %6.3f ", r.name.c_str(), r.wanted.c_str(),
                r.errors.size(), r.mean(), r.mean() - clean, r.median(), r.share_over(10));
    const double precision = ratio(r.both_absent, r.said_absent),
                 recall = ratio(r.both_absent, r.truly_absent);
    std::printf("%9.3f %9.3f %7d %9.3f %9.3f", precision, recall, r.failed,
                CaseResult::separation(r.confidence_here, r.confidence_gone),
                CaseResult::separation(r.border_here, r.border_gone));
    if (r.similarity) std::printf(" %9.2e", r.deviation);
    std::printf("\n");
  }
}

nlohmann::json json_of(const std::vector<CaseResult>& results) {
  const auto number = [](double x) { return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json(); };
  auto cases = nlohmann::json::array();
  for (const CaseResult& r : results) {
    nlohmann::json one{{"case", r.name},
                       {"wanted", r.wanted},
                       {"marks", r.errors.size()},
                       {"mean_edges", number(r.mean())},
                       {"beyond_clean_edges", number(r.mean() - results.front().mean())},
                       {"median_edges", number(r.median())},
                       {"over_10_edges", number(r.share_over(10))},
                       {"lost_in_holes", r.lost_in_holes},
                       {"said_absent", r.said_absent},
                       {"outcomes", r.outcomes},
                       {"failed_meshes", r.failed},
                       {"seconds", r.seconds}};
    if (r.missing) {
      one["truly_absent"] = r.truly_absent;
      one["absent_precision"] = number(ratio(r.both_absent, r.said_absent));
      one["absent_auroc_by_confidence"] =
          number(CaseResult::separation(r.confidence_here, r.confidence_gone));
      one["absent_auroc_by_border"] = number(CaseResult::separation(r.border_here, r.border_gone));
      one["absent_recall"] = number(ratio(r.both_absent, r.truly_absent));
    }
    if (r.similarity) one["deviation_edges"] = number(r.deviation);
    cases.push_back(one);
  }
  return cases;
}

}  // namespace focal_robustness
