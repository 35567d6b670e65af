#include "placing.h"

#include <algorithm>

#include "base/random.h"
#include "landmarks/params.h"

namespace focal_bench {

using namespace focal;

std::vector<int32_t> drawn_samples(int32_t vertex_count) {
  const DetectParams params;
  const auto wanted = static_cast<int32_t>(params.sampling_rate * vertex_count);
  Random random(params.seed);
  return sample_without_replacement(random, vertex_count,
                                    std::min(std::max(wanted, 100), params.max_samples));
}

Peaks peaks_of(const RowMatrixf& votes, const DistanceFields& fields) {
  constexpr double separation = 0.08;  // of sqrt(area)
  return find_peaks(votes, DetectParams().peaks_per_landmark, separation, 0, fields);
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
  std::vector<SurfacePoint> corner(mesh.surface.vertex_count()), points;
  for (int32_t t = 0; t < mesh.surface.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) corner[mesh.surface.triangles(t, i)] = {t, Vector3::Unit(i)};
  for (const int32_t v : vertices) points.push_back(corner[v]);
  candidates.directions = tangent_directions(mesh.surface, points, field, disc_radius, execution);
  const auto choice = choose_constellation(model.constellation, candidates, {}, execution);
  std::vector<int32_t> chosen;
  for (const int32_t c : choice.candidate) chosen.push_back(c < 0 ? -1 : vertices[c]);
  return chosen;
}

}  // namespace focal_bench
