// What the forest of preset `default` knows of a sample: its signature, how the surface bulges there and, where the training shapes
// agree on an orientation, where it lies and faces in the body's own frame.
#pragma once
#include "landmarks/surface_analysis.h"

namespace focal {

int32_t feature_count(const TrainParams& params);

// One row for each of the first `count` samples. frame: turns directions of the surface's coordinates into the body's (+Y up, +Z
// front); it matters only where params.oriented.
RowMatrixf features_of(const SurfaceAnalysis& analysis, int32_t count, const TrainParams& params,
                       const Matrix3& frame);

// The part of it that no motion changes, for the first `count` samples; and with it what no turn about the y axis changes of
// placed_features.
RowMatrixf invariant_features(const SurfaceAnalysis& analysis, int32_t count);
RowMatrixf upright_features(const SurfaceAnalysis& analysis, const RowMatrixf& placed);
int32_t invariant_feature_count(const TrainParams& params);
int32_t upright_feature_count(const TrainParams& params);

// Per sample its position from the centre of the surface and its normal, in surface coordinates: count x 6.
RowMatrixf placed_features(const SurfaceAnalysis& analysis, int32_t count);

// A number of placed_features as a model keeps it: a multiple of 1 / 4000 within -8..8. Training uses no finer one.
uint16_t place_to_file(float value);
float place_from_file(uint16_t value);

}  // namespace focal
