#include "landmarks/placement.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "base/stopwatch.h"
#include "landmarks/leaf_votes.h"
#include "landmarks/refine.h"
#include "vote/peaks.h"
#include "vote/vote.h"

namespace focal {
namespace {

constexpr int lanes = HeatMethod::lanes;
constexpr int32_t blocks_at_once = 4;     // fixed, so that memory and results do not depend on the threads
constexpr double peak_separation = 0.08;  // of sqrt(area), as measured in the reference
constexpr double disc_radius = 0.04;      // of the tangent directions, likewise

// votes: vertices x landmarks, of the first `count` samples.
RowMatrixf cast_votes(const LandmarkModel& model, const SurfaceAnalysis& analysis, int32_t count,
                      const Execution& execution, StageSeconds& seconds) {
  const int32_t n = analysis.heat.vertex_count();
  RowMatrixf votes = RowMatrixf::Zero(n, static_cast<Eigen::Index>(model.landmark_names.size()));
  std::vector<float> distances(static_cast<size_t>(blocks_at_once) * n * lanes);
  const size_t block_size = static_cast<size_t>(n) * lanes;
  Stopwatch watch;
  for (int32_t first = 0; first < count; first += blocks_at_once * lanes) {
    const int32_t batch = std::min(blocks_at_once * lanes, count - first);
    analysis.heat.for_each_block(std::span(analysis.samples).subspan(first, batch), execution,
                                 [&](int64_t at, int32_t, const float* block) {
                                   std::memcpy(&distances[at / lanes * block_size], block,
                                               block_size * sizeof(float));
                                 });
    seconds.geodesics += watch.lap();
    for (int32_t b = 0; b * lanes < batch; ++b) {
      const int32_t used = std::min(lanes, batch - b * lanes);
      const VoteTables tables =
          leaf_vote_tables(model, analysis.descriptors.middleRows(first + b * lanes, used), execution);
      seconds.forest += watch.lap();
      add_distribution_votes(tables, &distances[b * block_size], used, votes, execution);
      seconds.vote += watch.lap();
    }
    execution.report(static_cast<double>(first + batch) / count);
  }
  return votes;
}

ConstellationCandidates make_candidates(const std::vector<std::vector<int32_t>>& peaks,
                                        const RowMatrixf& votes, const PreparedMesh& mesh,
                                        const SurfaceAnalysis& analysis, std::vector<int32_t>& vertices,
                                        const Execution& execution) {
  ConstellationCandidates candidates;
  for (size_t l = 0; l < peaks.size(); ++l) {
    candidates.start.push_back(static_cast<int32_t>(vertices.size()));
    for (const int32_t v : peaks[l]) {
      vertices.push_back(v);
      candidates.unary.push_back(1 - votes(v, l) / votes(peaks[l][0], l));
    }
  }
  candidates.start.push_back(static_cast<int32_t>(vertices.size()));
  const RowMatrixf fields = analysis.heat.distances(vertices, execution);
  candidates.distance.resize(vertices.size(), vertices.size());
  for (size_t a = 0; a < vertices.size(); ++a)
    for (size_t b = 0; b < vertices.size(); ++b)
      candidates.distance(a, b) = (fields(a, vertices[b]) + fields(b, vertices[a])) / 2;
  std::vector<SurfacePoint> points;
  std::vector<SurfacePoint> corner(mesh.surface.vertex_count());
  for (int32_t t = 0; t < mesh.surface.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) corner[mesh.surface.triangles(t, i)] = {t, Vector3::Unit(i)};
  for (const int32_t v : vertices) points.push_back(corner[v]);
  candidates.directions = tangent_directions(mesh.surface, points, fields, disc_radius, execution);
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
                .rival = 0};
    for (const int32_t other : peaks[l])
      if (other != v) {
        result.rival[l] = other;
        evidence.rival = result.votes(other, l) / std::max(vote, 1e-30f);
        break;
      }
  }
}

}  // namespace

Placement place_landmarks(const LandmarkModel& model, const PreparedMesh& mesh,
                          const SurfaceAnalysis& analysis, int32_t sample_limit, const DetectParams& params,
                          const Execution& execution, StageSeconds& seconds) {
  Placement result;
  const int32_t samples = std::min(sample_limit, static_cast<int32_t>(analysis.samples.size()));
  result.votes = cast_votes(model, analysis, samples, execution, seconds);
  Stopwatch watch;
  const auto peaks =
      find_peaks(result.votes, params.peaks_per_landmark, peak_separation, 0,
                 [&](std::span<const int32_t> v) { return analysis.heat.distances(v, execution); });
  seconds.vote += watch.lap();
  std::vector<int32_t> vertices;
  const ConstellationCandidates candidates =
      make_candidates(peaks, result.votes, mesh, analysis, vertices, execution);
  const ConstellationChoice choice =
      choose_constellation(model.constellation, candidates, ConstellationParams{}, execution);
  result.energy = choice.energy;
  record_evidence(peaks, candidates, choice, samples, vertices, result);
  seconds.constellation += watch.lap();
  refine_placement(model.constellation, analysis, result, execution);
  seconds.refine += watch.lap();
  return result;
}

}  // namespace focal
