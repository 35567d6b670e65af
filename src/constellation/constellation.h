// Chooses the positions of all landmarks jointly among the peaks of their votes, by the training shapes'
// statistics of the distances between landmarks and of the chirality of their triples. An isometry preserves
// both, a reflection negates the second: this distinguishes left from right in any pose, without a symmetry
// plane.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/matrix.h"
#include "base/parallel.h"
#include "mesh/triangle_mesh.h"

namespace focal {

// Statistics over the training shapes. Distances in units of sqrt(area); chirality as in TangentDirections,
// -1..1.
struct ConstellationStatistics {
  int32_t landmarks = 0;
  RowMatrixf distance_mean, distance_sd;  // L x L, symmetric; sd > 0
  std::vector<float> chirality_mean,
      // [c][a][b]: at c, from the direction to a to the direction to b.
      chirality_sd;
  float mean(int32_t c, int32_t a, int32_t b) const { return chirality_mean[index(c, a, b)]; }
  size_t index(int32_t c, int32_t a, int32_t b) const {
    return (static_cast<size_t>(c) * landmarks + a) * landmarks + b;
  }
};

// At each point the direction to every other: the negative gradient of the distance to it, averaged over a
// small disc, in a right-handed tangent frame. chirality(c, a, b) = x(c, a) y(c, b) - y(c, a) x(c, b).
struct TangentDirections {
  RowMatrixf x, y;  // points x points
  float chirality(int32_t c, int32_t a, int32_t b) const { return x(c, a) * y(c, b) - y(c, a) * x(c, b); }
};
// points: surface points; fields: points x vertices, the distance from each of them; radius: of the disc, in
// the same unit.
TangentDirections tangent_directions(const TriangleMesh& mesh, std::span<const SurfacePoint> points,
                                     const RowMatrixf& fields, double radius, const Execution& execution);

// Relative positions of the landmarks of one training shape; rows of absent landmarks are not used.
struct ConstellationSample {
  std::vector<char> present;  // L
  RowMatrixf distance;        // L x L
  TangentDirections directions;
  bool has_chirality = true;  // its triangles are consistently oriented; else its chirality is not used
};
ConstellationStatistics learn_constellation(std::span<const ConstellationSample> samples, int32_t landmarks);

// Candidates of all landmarks in one list; those of landmark l are start[l] .. start[l + 1].
struct ConstellationCandidates {
  std::vector<int32_t> start;
  std::vector<float> unary;  // 0 for the best vote of its landmark, 1 for no votes
  RowMatrixf distance;       // all x all, in sqrt(area)
  TangentDirections directions;
  std::vector<char> certain = {};  // per landmark: known, never left out; empty: no landmark is known
};

struct ConstellationParams {
  double unary_weight = 5, pair_weight = 4, chirality_weight = 2;
  // Weight of distances to a known landmark, relative to those between others: docs/accuracy.md.
  double certain_weight = 4;
  double absent_cost = 7;  // of leaving out a landmark, relative to the cost of a position
  int32_t restarts = 32;
  double energy_margin = 12;  // of the other returned choices above the best
  int32_t max_choices = 4;
  uint64_t seed = 0;
};

struct ConstellationChoice {
  std::vector<int32_t> candidate;  // one per landmark; -1 when it has none
  std::vector<char> left_out;      // per landmark: no candidate fits the others; the best one is given
  double energy = 0;
  // Per landmark: mean clipped squared deviation of its distances from those not left out; 0 is perfect.
  std::vector<float> residual;
};

// The choice of least energy, then others of nearly the same energy that place many landmarks differently:
// when votes and distances do not distinguish front from back, further checks must decide.
std::vector<ConstellationChoice> choose_constellations(const ConstellationStatistics& statistics,
                                                       const ConstellationCandidates& candidates,
                                                       const ConstellationParams& params,
                                                       const Execution& execution);

}  // namespace focal
