// The joint choice of one place a landmark among the peaks of their votes, by what training shapes say of the distances
// between landmarks and of the chirality of their triples. An isometry keeps both, a reflection negates the second: so
// left and right are told apart in any pose, with no symmetry plane.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/matrix.h"
#include "base/parallel.h"
#include "mesh/triangle_mesh.h"

namespace focal {

// Over the training shapes. Distances in units of sqrt(area); chirality as in TangentDirections, -1..1.
struct ConstellationStatistics {
  int32_t landmarks = 0;
  RowMatrixf distance_mean, distance_sd;  // L x L, symmetric; sd > 0
  std::vector<float> chirality_mean,
      chirality_sd;  // [c][a][b]: at c, from the way to a round to the way to b
  float mean(int32_t c, int32_t a, int32_t b) const { return chirality_mean[index(c, a, b)]; }
  size_t index(int32_t c, int32_t a, int32_t b) const {
    return (static_cast<size_t>(c) * landmarks + a) * landmarks + b;
  }
};

// At each point, the way to every other: the negative gradient of the distance to it, averaged over a small disc and
// given in a right-handed tangent frame. chirality(c, a, b) = x(c, a) y(c, b) - y(c, a) x(c, b).
struct TangentDirections {
  RowMatrixf x, y;  // points x points
  float chirality(int32_t c, int32_t a, int32_t b) const { return x(c, a) * y(c, b) - y(c, a) * x(c, b); }
};
// points: surface points; fields: points x vertices, the distance from each of them; radius: of the disc, same unit.
TangentDirections tangent_directions(const TriangleMesh& mesh, std::span<const SurfacePoint> points,
                                     const RowMatrixf& fields, double radius, const Execution& execution);

// Where the landmarks of one training shape lie to each other; rows of absent landmarks are not used.
struct ConstellationSample {
  std::vector<char> present;  // L
  RowMatrixf distance;        // L x L
  TangentDirections directions;
  bool has_chirality = true;  // its triangles all face one way; else nothing is learned of its chirality
};
ConstellationStatistics learn_constellation(std::span<const ConstellationSample> samples, int32_t landmarks);

// Candidates of all landmarks in one list; those of landmark l are start[l] .. start[l + 1].
struct ConstellationCandidates {
  std::vector<int32_t> start;
  std::vector<float> unary;  // 0 for the best vote of its landmark, 1 for none
  RowMatrixf distance;       // all x all, of sqrt(area)
  TangentDirections directions;
  std::vector<char> certain = {};  // per landmark: known, never left out; empty: none is
};

struct ConstellationParams {
  double unary_weight = 5, pair_weight = 4, chirality_weight = 2;
  double certain_weight =
      4;  // of distances to a landmark that is certain, against those between others: docs/accuracy.md
  double absent_cost = 7;  // of leaving a landmark out, against all that a place costs
  int32_t restarts = 32;
  double energy_margin = 12;  // of the other choices above the best
  int32_t max_choices = 4;
  uint64_t seed = 0;
};

struct ConstellationChoice {
  std::vector<int32_t> candidate;  // one a landmark; -1 when it has none
  std::vector<char> left_out;  // per landmark: no candidate suits the others; its own is the best there is
  double energy = 0;
  // Per landmark: mean clipped squared deviation of its distances from those not left out, 0 is perfect.
  std::vector<float> residual;
};

// The choice of least energy, then others that are hardly worse and put many landmarks elsewhere: on a shape that looks
// the same front and back to its votes and distances, only a closer look can tell.
std::vector<ConstellationChoice> choose_constellations(const ConstellationStatistics& statistics,
                                                       const ConstellationCandidates& candidates,
                                                       const ConstellationParams& params,
                                                       const Execution& execution);

}  // namespace focal
