// Features of a sample for the forest of preset `default`: its signature, the bulge of the surface and, where
// the training shapes agree on an orientation, position and normal in the body's own frame.
#pragma once
#include <span>

#include "analysis/surface_analysis.h"
#include "model/feature_layout.h"

namespace focal {

// One row for each of the first `count` samples. frame: rotates directions from the surface's coordinates
// into the body's (+Y up, +Z front); used only with params.oriented.
RowMatrixf features_of(const SurfaceAnalysis& analysis, int32_t count, const TrainParams& params,
                       const Matrix3& frame);

// Vertices and their descriptors, one row each.
struct Described {
  std::span<const int32_t> vertices;
  Eigen::Ref<const RowMatrixf> descriptors;
};
Described first_samples(const SurfaceAnalysis& analysis, int32_t count);

// One row for each vertex: the features that no motion changes; and the same together with the parts of
// placed_features that no rotation about the y axis changes.
RowMatrixf invariant_features(const SurfaceAnalysis& analysis, const Described& of);
RowMatrixf upright_features(const SurfaceAnalysis& analysis, const Described& of, const RowMatrixf& placed);

// Per vertex its position relative to the centre of the surface and its normal, in surface coordinates:
// n x 6.
RowMatrixf placed_features(const SurfaceAnalysis& analysis, std::span<const int32_t> vertices);

}  // namespace focal
