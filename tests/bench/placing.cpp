#include "placing.h"

#include <algorithm>

#include "base/random.h"
#include "model/params.h"

namespace focal_bench {

using namespace focal;

std::vector<int32_t> drawn_samples(int32_t vertex_count) {
  const DetectParams params;
  const double rate = sampling_rate_of(params, TrainParams::from_preset(Preset::paper));
  Random random(params.seed);
  const auto wanted = static_cast<int32_t>(rate * vertex_count);
  return sample_without_replacement(random, vertex_count,
                                    std::min(std::max(wanted, 100), params.max_samples));
}

Peaks peaks_of(const RowMatrixf& votes, int32_t landmarks, const TriangleMesh& mesh,
               const Operators& operators, const Execution& execution) {
  constexpr double separation = 0.08;  // of sqrt(area)
  return find_peaks(
      votes, landmarks, DetectParams().peaks_per_landmark, 0,
      [&](int32_t v) { return connected_ball(operators.L, mesh.positions, v, separation); }, execution);
}

std::vector<int32_t> choose_among(const Peaks& peaks, const RowMatrixf& votes, const LandmarkModel& model,
                                  const PreparedMesh& mesh, const DistanceFields& fields,
                                  const Execution& execution) {
  constexpr double disc_radius = 0.04;  // of sqrt(area)
  ConstellationCandidates candidates;
  std::vector<int32_t> vertices;
  for (size_t l = 0; l < peaks.size(); ++l) {
    candidates.start.push_back(static_cast<int32_t>(vertices.size()));
    for (const int32_t v : peaks[l]) {
      vertices.push_back(v);
      candidates.unary.push_back(1 - votes(v, l) / votes(peaks[l][0], l));
    }
  }
  candidates.start.push_back(static_cast<int32_t>(vertices.size()));
  const RowMatrixf field = fields(vertices);
  candidates.distance.resize(vertices.size(), vertices.size());
  for (size_t a = 0; a < vertices.size(); ++a)
    for (size_t b = 0; b < vertices.size(); ++b)
      candidates.distance(a, b) = (field(a, vertices[b]) + field(b, vertices[a])) / 2;
  candidates.directions =
      tangent_directions(mesh.surface, points_at(mesh.surface, vertices), field, disc_radius, execution);
  const auto choice = choose_constellations(model.constellation, candidates, {}, execution).front();
  std::vector<int32_t> chosen;
  for (const int32_t c : choice.candidate) chosen.push_back(c < 0 ? -1 : vertices[c]);
  return chosen;
}

}  // namespace focal_bench
