// What the forest of preset `default` knows of a sample: its signature, how the surface bulges there and, where the training shapes
// agree on an orientation, where it lies and faces in the body's own frame.
#pragma once
#include "analysis/surface_analysis.h"
#include "model/feature_layout.h"

namespace focal {

// One row for each of the first `count` samples. frame: turns directions of the surface's coordinates into the body's (+Y up, +Z
// front); it matters only where params.oriented.
RowMatrixf features_of(const SurfaceAnalysis& analysis, int32_t count, const TrainParams& params,
                       const Matrix3& frame);

// The part of it that no motion changes, for the first `count` samples; and with it what no turn about the y axis changes of
// placed_features.
RowMatrixf invariant_features(const SurfaceAnalysis& analysis, int32_t count);
RowMatrixf upright_features(const SurfaceAnalysis& analysis, const RowMatrixf& placed);

// Per sample its position from the centre of the surface and its normal, in surface coordinates: count x 6.
RowMatrixf placed_features(const SurfaceAnalysis& analysis, int32_t count);

}  // namespace focal
