#include "landmarks/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/stopwatch.h"
#include "landmarks/consensus.h"
#include "landmarks/exemplar_choice.h"
#include "landmarks/features.h"
#include "landmarks/orientation.h"
#include "landmarks/refinement.h"
#include "landmarks/shape_starts.h"
#include "mesh/fill_holes.h"
#include "mesh/nearest_vertex.h"
#include "paper/paper.h"

namespace focal {
namespace {

constexpr double peak_separation = 0.08;  // in sqrt(area), as measured in the reference
constexpr double disc_radius = 0.04;      // of the tangent directions, likewise
// Weight of the maps' residual against the constellation's energy, where several constellations are nearly
// optimal. On uncorrupted and corrupted training shapes left out (six categories, 480 pairs of which one was
// correct), 800 corrected 11 and broke 2.
constexpr double residual_weight = 800;
// The same for the correlation of the bulge, and for the mean logarithm of the best votes.
constexpr double bulge_weight = 80, level_weight = 10;
// With an assumed heading, votes are nearly correct: fewer candidates and restarts suffice.
constexpr int32_t oriented_peaks = 5, oriented_restarts = 12;
// Hypotheses whose energy exceeds the best by more than this are dropped.
constexpr double energy_margin = 20;
// With at least this bulge agreement of the maps from the votes' places, no training shapes are overlaid.
constexpr double convincing_bulge = 0.15;
constexpr size_t tried_starts = 3;  // overlaid training shapes, per heading
// Relative to the smallest distance: headings with a larger one are rejected.
constexpr double cover_margin = 1.06;
constexpr int32_t few_shapes = 3;  // whose maps evaluate the votes' places

// The known landmarks, on the analysed surface.
std::vector<std::optional<SurfacePoint>> fixed_places(const DetectParams& params,
                                                      const SurfaceAnalysis& analysis) {
  auto result = params.fixed;
  for (auto& place : result)
    if (place) place = to_coarse(analysis.proxy, std::span(&*place, 1))[0];
  return result;
}

ConstellationCandidates make_candidates(const std::vector<std::vector<int32_t>>& peaks,
                                        const RowMatrixf& votes, const SurfaceAnalysis& analysis,
                                        std::vector<int32_t>& vertices, const Execution& execution) {
  ConstellationCandidates candidates;
  for (size_t l = 0; l < peaks.size(); ++l) {
    candidates.start.push_back(static_cast<int32_t>(vertices.size()));
    for (const int32_t v : peaks[l]) {
      vertices.push_back(v);
      const float best = votes(peaks[l][0], l);
      candidates.unary.push_back(best > 0 ? 1 - votes(v, l) / best : 0);
    }
  }
  candidates.start.push_back(static_cast<int32_t>(vertices.size()));
  const RowMatrixf fields = analysis.metric->distances(vertices, execution);
  candidates.distance.resize(vertices.size(), vertices.size());
  for (size_t a = 0; a < vertices.size(); ++a)
    for (size_t b = 0; b < vertices.size(); ++b)
      candidates.distance(a, b) = (fields(a, vertices[b]) + fields(b, vertices[a])) / 2;
  candidates.directions = tangent_directions(analysis.surface(), points_at(analysis.surface(), vertices),
                                             fields, disc_radius, execution);
  return candidates;
}

void record_placement_features(const std::vector<std::vector<int32_t>>& peaks,
                               const ConstellationCandidates& candidates, const ConstellationChoice& choice,
                               int32_t sample_count, const std::vector<int32_t>& vertices,
                               Placement& result) {
  const auto L = static_cast<int32_t>(peaks.size());
  result.vertex.assign(L, -1), result.runner_up.assign(L, -1), result.features.assign(L, {});
  for (int32_t l = 0; l < L; ++l) {
    if (choice.candidate[l] < 0) continue;
    const int32_t v = result.vertex[l] = vertices[choice.candidate[l]];
    const float vote = result.votes(v, l);
    PlacementFeatures& features = result.features[l];
    features = {.vote_ratio = 1 - candidates.unary[choice.candidate[l]],
                .residual = choice.residual[l],
                .vote_level = vote / static_cast<float>(sample_count),
                .runner_up = 0,
                .left_out = choice.left_out[l] != 0};
    for (const int32_t other : peaks[l])
      if (other != v) {
        result.runner_up[l] = other;
        features.runner_up = result.votes(other, l) / std::max(vote, 1e-30f);
        break;
      }
  }
}

// Distance of each place from a stump: a closed border longer than that of a small hole.
void record_borders(const SurfaceAnalysis& analysis, Placement& placement) {
  constexpr double long_border = 0.15;  // in sqrt(area)
  if (analysis.proxy.filled_holes == 0) return;
  const TriangleMesh& full = analysis.proxy.full->surface;
  const PreparedMesh& coarse = *analysis.proxy.coarse;
  std::vector<int32_t> border;
  for (const auto& loop : border_loops(full)) {
    double length = 0;
    for (size_t i = 0; i < loop.size(); ++i)
      length += (full.positions.row(loop[i]) - full.positions.row(loop[(i + 1) % loop.size()])).norm();
    if (length > long_border) border.insert(border.end(), loop.begin(), loop.end());
  }
  if (border.empty()) return;
  const NearestVertex search(full.positions, std::move(border));
  for (size_t l = 0; l < placement.vertex.size(); ++l) {
    if (placement.vertex[l] < 0) continue;
    const Vector3 place = coarse.centre + coarse.scale * position_of(coarse.surface, placement.point[l]);
    placement.features[l].border = static_cast<float>(std::sqrt(search.nearest(place).second) / coarse.scale);
  }
}

// One assumed orientation of the body, and its results.
struct Supposition {
  std::vector<std::vector<int32_t>> peaks;
  std::vector<int32_t> vertices;
  ConstellationCandidates candidates;
  ConstellationStatistics statistics;
  std::vector<ConstellationChoice> choices;
  Placement start;
  double penalty = 0;

  double min_cost() const { return choices[0].energy + penalty; }
};

double min_cost(const std::vector<Supposition>& suppositions) {
  double least = std::numeric_limits<double>::infinity();
  for (const Supposition& one : suppositions) least = std::min(least, one.min_cost());
  return least;
}

Supposition suppose(const LandmarkModel& model, const SurfaceAnalysis& analysis, const Heading& heading,
                    int32_t samples, const DetectParams& params, const Execution& execution,
                    StageSeconds& seconds) {
  Supposition result;
  Placement& start = result.start;
  const RowMatrixf features = features_of(analysis, samples, model.params, heading.frame);
  start.frame = heading.frame, start.heading_advantage = heading.advantage;
  result.penalty = heading.penalty;
  start.exemplars = most_alike(model, features, used_exemplars);
  result.statistics = statistics_of(model, start.exemplars);
  start.votes = analysis.engine->votes(analysis, model, features, execution, seconds);
  Stopwatch watch;
  const auto L = static_cast<int32_t>(start.votes.cols());
  const int32_t wanted =
      model.params.oriented ? std::min(params.peaks_per_landmark, oriented_peaks) : params.peaks_per_landmark;
  auto& peaks = result.peaks;
  peaks = analysis.engine->peaks(analysis, start.votes, wanted, peak_separation, execution);
  seconds.vote += watch.lap();
  start.fixed = fixed_places(params, analysis);
  std::vector<char> certain(start.fixed.size());
  for (size_t l = 0; l < start.fixed.size(); ++l)
    if ((certain[l] = start.is_fixed(l))) peaks[l] = {nearest_corner(analysis.surface(), *start.fixed[l])};
  result.candidates = make_candidates(peaks, start.votes, analysis, result.vertices, execution);
  result.candidates.certain = std::move(certain);
  ConstellationParams how;
  if (model.params.oriented) how.restarts = oriented_restarts, how.energy_margin = energy_margin;
  if (!analysis.proxy.full->is_oriented) how.chirality_weight = 0;
  result.choices = choose_constellations(result.statistics, result.candidates, how, execution);
  // The value of the votes compared with those of another assumption: a wrong one scatters them.
  for (int32_t l = 0; l < L; ++l)
    result.penalty -= level_weight / L *
                      std::log(std::max(start.votes.col(l).maxCoeff() / static_cast<float>(samples), 1e-9f));
  seconds.constellation += watch.lap();
  return result;
}

struct Hypothesis {
  double energy = 0;  // of the choice and its assumption
  Placement placement;
  double cost = 0, bulge_agreement = 0;  // see judge
};

// The hypotheses that the votes suggest.
std::vector<Hypothesis> hypotheses_of(const std::vector<Supposition>& suppositions, int32_t samples,
                                      const SurfaceAnalysis& analysis, const Execution& execution) {
  const double least = min_cost(suppositions);
  std::vector<Hypothesis> result;
  for (const Supposition& from : suppositions)
    for (const ConstellationChoice& choice : from.choices) {
      if (choice.energy + from.penalty > least + energy_margin) continue;
      result.push_back({choice.energy + from.penalty, from.start});
      record_placement_features(from.peaks, from.candidates, choice, samples, from.vertices,
                                result.back().placement);
      refine_placement(from.statistics, analysis, result.back().placement, execution);
    }
  return result;
}

// Landmarks at the positions of an overlaid training shape.
Hypothesis hypothesis_of(const LandmarkModel& model, const Supposition& from,
                         const std::vector<int32_t>& exemplars, const std::vector<SurfacePoint>& places,
                         int32_t samples, const SurfaceAnalysis& analysis, const Execution& execution) {
  Hypothesis result{from.min_cost(), from.start};
  Placement& placement = result.placement;
  placement.exemplars = exemplars;
  std::vector<std::vector<int32_t>> corners(places.size());
  for (size_t l = 0; l < places.size(); ++l)
    if (placement.is_fixed(l) || places[l].triangle >= 0)
      corners[l] = {
          nearest_corner(analysis.surface(), placement.is_fixed(l) ? *placement.fixed[l] : places[l])};
  std::vector<int32_t> vertices;
  ConstellationCandidates candidates =
      make_candidates(corners, placement.votes, analysis, vertices, execution);
  candidates.certain = from.candidates.certain;
  for (size_t l = 0; l < places.size(); ++l)
    for (int32_t i = candidates.start[l]; i < candidates.start[l + 1]; ++i)
      candidates.unary[i] =
          1 - placement.votes(vertices[i], l) / std::max(placement.votes.col(l).maxCoeff(), 1e-30f);
  const auto choices = choose_constellations(statistics_of(model, exemplars), candidates,
                                             {.restarts = 1, .max_choices = 1}, execution);
  record_placement_features(from.peaks, candidates, choices[0], samples, vertices, placement);
  placement.point = places;
  for (size_t l = 0; l < places.size(); ++l)
    if (placement.is_fixed(l)) placement.point[l] = *placement.fixed[l];
  return result;
}

// Computes the costs of the hypotheses by maps from them and sorts by cost. shapes: see quick_map_fit.
void rank_by_maps(const LandmarkModel& model, const SurfaceAnalysis& analysis, int32_t shapes,
                  const Execution& execution, std::vector<Hypothesis>& hypotheses) {
  for (Hypothesis& one : hypotheses) {
    const MapFit fit = quick_map_fit(model, analysis, one.placement, shapes, execution);
    one.cost = one.energy + residual_weight * fit.residual - bulge_weight * fit.bulge_agreement;
    one.bulge_agreement = fit.bulge_agreement;
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const auto& a, const auto& b) { return a.cost < b.cost; });
}

// Adds hypotheses from training shapes overlaid on the body, in every likely orientation in which they cover
// it well.
void add_laid_over(const LandmarkModel& model, const std::vector<Supposition>& suppositions, int32_t samples,
                   const SurfaceAnalysis& analysis, const Execution& execution,
                   std::vector<Hypothesis>& hypotheses) {
  const double limit = min_cost(suppositions) + energy_margin;
  std::vector<ShapeStarts> over;
  double least = std::numeric_limits<double>::infinity();
  for (const Supposition& from : suppositions) {
    over.push_back(from.min_cost() > limit ? ShapeStarts{}
                                           : lay_shapes_over(model, analysis, from.start.frame,
                                                             used_exemplars, tried_starts, execution));
    if (!over.back().places.empty()) least = std::min(least, over.back().apart);
  }
  for (size_t s = 0; s < suppositions.size(); ++s)
    if (over[s].apart < cover_margin * least)
      for (const auto& places : over[s].places)
        hypotheses.push_back(
            hypothesis_of(model, suppositions[s], over[s].exemplars, places, samples, analysis, execution));
}

}  // namespace

Placement place_landmarks(const LandmarkModel& model, const SurfaceAnalysis& analysis, int32_t sample_limit,
                          const DetectParams& params, const Execution& execution, StageSeconds& seconds,
                          const std::optional<Matrix3>& frame) {
  const int32_t samples = std::min(sample_limit, static_cast<int32_t>(analysis.samples.size()));
  const std::vector<Heading> headings =
      frame ? std::vector<Heading>{{*frame, 0}} : headings_to_try(model, analysis, params.orientation);
  std::vector<Supposition> suppositions;
  for (const Heading& heading : headings)
    suppositions.push_back(suppose(model, analysis, heading, samples, params, execution, seconds));
  Stopwatch watch;
  std::vector<Hypothesis> hypotheses = hypotheses_of(suppositions, samples, analysis, execution);
  const bool lays_over = can_be_laid_over(model);
  if (hypotheses.size() > 1 || lays_over) rank_by_maps(model, analysis, few_shapes, execution, hypotheses);
  if (lays_over && hypotheses[0].bulge_agreement < convincing_bulge) {
    add_laid_over(model, suppositions, samples, analysis, execution, hypotheses);
    rank_by_maps(model, analysis, 0, execution, hypotheses);
  }
  Placement result = std::move(hypotheses[0].placement);
  result.cost_margin = hypotheses.size() > 1 ? hypotheses[1].cost - hypotheses[0].cost
                                             : std::numeric_limits<double>::infinity();
  join_transferred_landmarks(model, analysis, params.quality, result, execution);
  record_borders(analysis, result);
  seconds.refine += watch.lap();
  return result;
}

Placement place_landmarks_paper(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                const DetectParams& params, const Execution& execution,
                                StageSeconds& seconds) {
  PaperVotes votes = paper_votes(model, analysis, params.seed, execution, seconds);
  Placement result;
  for (const float level : votes.level) result.features.push_back({.vote_ratio = 1, .vote_level = level});
  result.runner_up.assign(votes.vertex.size(), -1);
  result.point = points_at(analysis.surface(), votes.vertex);
  result.vertex = std::move(votes.vertex), result.votes = std::move(votes.votes);
  return result;
}

}  // namespace focal
