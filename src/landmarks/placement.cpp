#include "landmarks/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/stopwatch.h"
#include "landmarks/backend_surface.h"
#include "landmarks/consensus.h"
#include "landmarks/exemplars.h"
#include "landmarks/features.h"
#include "landmarks/leaf_votes.h"
#include "landmarks/orientation.h"
#include "landmarks/refine.h"
#include "mesh/fill_holes.h"
#include "mesh/nearest_vertex.h"
#include "vote/peaks.h"
#include "vote/vote.h"

namespace focal {
namespace {

constexpr int32_t samples_at_once = 128;  // whose tables are in memory; a multiple of 32
constexpr double peak_separation = 0.08;  // of sqrt(area), as measured in the reference
constexpr double disc_radius = 0.04;      // of the tangent directions, likewise
// Of the maps' residual against the constellation's energy, where several constellations come near the best. On whole and
// spoiled training shapes left out (six categories, 480 pairs of which one was right), 800 mended 11 and spoiled 2.
constexpr double residual_weight = 800;
// Likewise of the correlation of how the surfaces bulge, and of the mean logarithm of the best votes.
constexpr double bulge_weight = 80, level_weight = 10;
// Where a heading is supposed, votes are nearly right: fewer candidates and starts do.
constexpr int32_t oriented_peaks = 5, oriented_restarts = 12;
constexpr double energy_margin = 20;  // hypotheses that cost more than the best by this are not looked at

// Votes of the first `count` samples, vertices x landmarks.
RowMatrixf cast_votes(const LandmarkModel& model, const SurfaceAnalysis& analysis, const RowMatrixf& features,
                      const Execution& execution, StageSeconds& seconds) {
  const auto count = static_cast<int32_t>(features.rows());
  const auto L = static_cast<int32_t>(model.landmark_names.size());
  RowMatrixf votes = RowMatrixf::Zero(analysis.metric->vertex_count(), VoteTables::padded(L));
  Stopwatch watch;
  if (analysis.on_backend) {
    votes = analysis.on_backend->votes(model, std::span(analysis.samples).first(count), features);
    seconds.vote += watch.lap();  // forest, distances and votes in one
    return votes.leftCols(L);
  }
  const LeafVotes leaf_votes(model, features, execution);
  seconds.forest += watch.lap();
  for_each_portion(
      analysis, count, execution, [&](int32_t first, int32_t used, const SampleDistances& portion) {
        seconds.geodesics += watch.lap();
        for (int32_t from = 0; from < used; from += samples_at_once) {
          const int32_t some = std::min(samples_at_once, used - from);
          const VoteTables tables = leaf_votes.tables(first + from, some, execution);
          seconds.forest += watch.lap();
          add_distribution_votes(tables, some, {portion.steps.data(), portion.step, portion.vertices}, from,
                                 votes, execution);
          seconds.vote += watch.lap();
        }
      });
  return votes.leftCols(L);
}

// The places that the caller knows, on the analysed surface.
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

void record_evidence(const std::vector<std::vector<int32_t>>& peaks,
                     const ConstellationCandidates& candidates, const ConstellationChoice& choice,
                     int32_t sample_count, const std::vector<int32_t>& vertices, Placement& result) {
  const auto L = static_cast<int32_t>(peaks.size());
  result.vertex.assign(L, -1), result.rival.assign(L, -1), result.evidence.assign(L, {});
  for (int32_t l = 0; l < L; ++l) {
    if (choice.candidate[l] < 0) continue;
    const int32_t v = result.vertex[l] = vertices[choice.candidate[l]];
    const float vote = result.votes(v, l);
    Evidence& evidence = result.evidence[l];
    evidence = {.vote_ratio = 1 - candidates.unary[choice.candidate[l]],
                .residual = choice.residual[l],
                .vote_level = vote / static_cast<float>(sample_count),
                .rival = 0,
                .left_out = choice.left_out[l] != 0};
    for (const int32_t other : peaks[l])
      if (other != v) {
        result.rival[l] = other;
        evidence.rival = result.votes(other, l) / std::max(vote, 1e-30f);
        break;
      }
  }
}

// How near each place is to a stump: a border that was closed and is longer than that of a small hole.
void record_borders(const SurfaceAnalysis& analysis, Placement& placement) {
  constexpr double long_border = 0.15;  // of sqrt(area)
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
    placement.evidence[l].border = static_cast<float>(std::sqrt(search.nearest(place).second) / coarse.scale);
  }
}

// One way in which the body may be oriented, and what it leads to.
struct Supposition {
  std::vector<std::vector<int32_t>> peaks;
  std::vector<int32_t> vertices;
  ConstellationCandidates candidates;
  ConstellationStatistics statistics;
  std::vector<ConstellationChoice> choices;
  Placement start;
  double penalty = 0;
};

Supposition suppose(const LandmarkModel& model, const SurfaceAnalysis& analysis, const Heading& heading,
                    int32_t samples, const DetectParams& params, const Execution& execution,
                    StageSeconds& seconds) {
  Supposition result;
  Placement& start = result.start;
  const RowMatrixf features = features_of(analysis, samples, model.params, heading.frame);
  start.frame = heading.frame, result.penalty = heading.penalty;
  start.exemplars = most_alike(model, features, used_exemplars);
  result.statistics = statistics_of(model, start.exemplars);
  start.votes = cast_votes(model, analysis, features, execution, seconds);
  Stopwatch watch;
  const auto L = static_cast<int32_t>(start.votes.cols());
  const auto surroundings = [&](int32_t v) {
    return connected_ball(analysis.operators.L, analysis.surface().positions, v, peak_separation);
  };
  const int32_t wanted =
      model.params.oriented ? std::min(params.peaks_per_landmark, oriented_peaks) : params.peaks_per_landmark;
  auto& peaks = result.peaks;
  peaks = analysis.on_backend ? analysis.on_backend->peaks(L, wanted, peak_separation)
                              : find_peaks(start.votes, L, wanted, 0, surroundings, execution);
  seconds.vote += watch.lap();
  start.fixed = fixed_places(params, analysis);
  std::vector<char> certain(start.fixed.size());
  for (size_t l = 0; l < start.fixed.size(); ++l)
    if ((certain[l] = start.is_fixed(l))) peaks[l] = {nearest_corner(analysis.surface(), *start.fixed[l])};
  result.candidates = make_candidates(peaks, start.votes, analysis, result.vertices, execution);
  result.candidates.certain = std::move(certain);
  ConstellationParams how;
  if (model.params.oriented) how.restarts = oriented_restarts, how.energy_margin = energy_margin;
  if (!analysis.proxy.full->is_oriented) how.handedness_weight = 0;
  result.choices = choose_constellations(result.statistics, result.candidates, how, execution);
  // What the votes are worth beside those of another supposition: a wrong one scatters them.
  for (int32_t l = 0; l < L; ++l)
    result.penalty -= level_weight / L *
                      std::log(std::max(start.votes.col(l).maxCoeff() / static_cast<float>(samples), 1e-9f));
  seconds.constellation += watch.lap();
  return result;
}

}  // namespace

Placement place_landmarks(const LandmarkModel& model, const SurfaceAnalysis& analysis, int32_t sample_limit,
                          const DetectParams& params, const Execution& execution, StageSeconds& seconds,
                          const std::optional<Matrix3>& frame) {
  const int32_t samples = std::min(sample_limit, static_cast<int32_t>(analysis.samples.size()));
  const std::vector<Heading> headings =
      frame ? std::vector<Heading>{{*frame, 0}} : headings_to_try(model, analysis, params.orientation);
  std::vector<Supposition> suppositions;
  double least_energy = std::numeric_limits<double>::infinity();
  for (const Heading& heading : headings) {
    suppositions.push_back(suppose(model, analysis, heading, samples, params, execution, seconds));
    least_energy =
        std::min(least_energy, suppositions.back().choices[0].energy + suppositions.back().penalty);
  }
  Stopwatch watch;
  struct Hypothesis {
    size_t supposition, choice;
    double cost;
    Placement placement;
  };
  std::vector<Hypothesis> hypotheses;
  for (size_t s = 0; s < suppositions.size(); ++s)
    for (size_t c = 0; c < suppositions[s].choices.size(); ++c)
      if (const double cost = suppositions[s].choices[c].energy + suppositions[s].penalty;
          cost <= least_energy + energy_margin)
        hypotheses.push_back({s, c, cost, {}});
  for (Hypothesis& one : hypotheses) {
    const Supposition& from = suppositions[one.supposition];
    one.placement = from.start;
    record_evidence(from.peaks, from.candidates, from.choices[one.choice], samples, from.vertices,
                    one.placement);
    refine_placement(from.statistics, analysis, one.placement, execution);
    if (hypotheses.size() == 1) break;
    const MapFit fit = quick_map_fit(model, analysis, one.placement, execution);
    one.cost += residual_weight * fit.residual - bulge_weight * fit.bulge_agreement;
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const auto& a, const auto& b) { return a.cost < b.cost; });
  Placement result = std::move(hypotheses[0].placement);
  result.runner_up = hypotheses.size() > 1 ? hypotheses[1].cost - hypotheses[0].cost
                                           : std::numeric_limits<double>::infinity();
  join_carried_marks(model, analysis, params.quality, result, execution);
  record_borders(analysis, result);
  seconds.refine += watch.lap();
  return result;
}

}  // namespace focal
