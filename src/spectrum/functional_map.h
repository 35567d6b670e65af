// Maps between two surfaces as small matrices between their eigenbases (M. Ovsjanikov et al., "Functional Maps: A Flexible
// Representation of Maps Between Shapes", 2012), refined by spectral upsampling (S. Melzi et al., "ZoomOut: Spectral
// Upsampling for Efficient Shape Correspondence", 2019).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/matrix.h"
#include "base/parallel.h"

namespace focal {

// Points spread over a surface of area 1, with the values of its eigenfunctions there.
struct SpectralSamples {
  RowMatrixf Phi;          // points x k
  Eigen::VectorXf weight;  // the area that each point represents; 0: mapped, but not used in the fit
};

// The surface that is mapped to: its eigenfunctions at all vertices, and some vertices spread over it, which
// represent all of them until the last round.
struct SpectralTargets {
  RowMatrixf Phi;  // vertices x k
  std::vector<int32_t> spread;
  MatrixX3 positions;  // of the vertices, on a surface of area 1
};

// Positions of points on that surface: each between a few vertices, the nearest first, with weights that sum
// to 1. A single vertex would be a decision per point that a rounding error can change. Vertices far from the
// nearest have no weight: where two sides of a body look alike, the mean of both would be inside it.
struct PlacesBetween {
  static constexpr int32_t vertices = 3;
  std::vector<int32_t> vertex;  // points x vertices
  std::vector<float> weight;    // the same

  PlacesBetween() = default;
  PlacesBetween(const std::vector<int32_t>& whole)  // each at one vertex
      : vertex(whole.size() * vertices), weight(whole.size() * vertices) {
    for (size_t i = 0; i < vertex.size(); ++i)
      vertex[i] = whole[i / vertices], weight[i] = i % vertices == 0 ? 1.0F : 0.0F;
  }
};

struct MapParams {
  int32_t first = 20, last = 120, step = 20;  // number of eigenfunctions per round; multiples of 4
  // In the last round, points from this one on are mapped to the nearest of all targets, those before it
  // still to spread ones.
  int32_t exact_from = 0;
};

// Phi_from C approximates Phi_to at the images; Phi_to C^T maps the targets into the embedding of `from`,
// where points are compared.
struct FunctionalMap {
  Eigen::MatrixXf C;           // k x k
  std::vector<int32_t> image;  // per point: the nearest vertex of the targets
  PlacesBetween places;        // the same, between the nearest ones
  // Distance of the points from their images in the embedding: root mean square, relative to their size.
  float residual = 0;
};

// Refines `initial`, the initial position of each point. Both have at least 4 eigenfunctions.
FunctionalMap zoom_out(const SpectralSamples& from, const SpectralTargets& to, PlacesBetween initial,
                       const MapParams& params, const Execution& execution = {});

// For each row of places the nearest row of targets; the first of equal ones.
std::vector<int32_t> nearest_rows(const RowMatrixf& places, const RowMatrixf& targets);

// The same, between the nearest rows. positions: of the targets, as in SpectralTargets; empty: use all of the
// nearest.
PlacesBetween nearest_between(const RowMatrixf& places, const RowMatrixf& targets,
                              const MatrixX3& positions = {});

// `count` points, each the one farthest from those before it, starting with `first`.
std::vector<int32_t> farthest_points(const MatrixX3& positions, int32_t count, int32_t first = 0);

}  // namespace focal
