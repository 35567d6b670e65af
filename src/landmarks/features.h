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

}  // namespace focal
