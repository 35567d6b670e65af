// Where whole training shapes, laid over a new one, put the landmarks. Votes look at each place by itself: what sticks out of a large
// hat lies where the arms of most bodies do. Laid over, a training shape with such a head shows which is which.
#pragma once
#include <vector>

#include "analysis/surface_analysis.h"
#include "model/landmark_model.h"

namespace focal {

// The middle of weighted points, and how far they spread along each axis.
struct Extents {
  Vector3 mean, deviation;
};
Extents extents_of(const MatrixX3& points, const Vector& weight);

// What points of one shape are scaled by along each axis, so that they spread as those of the other do; no axis much more than the others.
Vector3 scale_onto(const Extents& shape, const Extents& other);

struct ShapeStarts {
  std::vector<int32_t> exemplars;  // the training shapes that cover it best, the best first
  double apart = 0;                // of the best: mean distance from the other shape, there and back
  // Of the landmarks, by the first few of these; triangle -1: it has no such mark.
  std::vector<std::vector<SurfacePoint>> places;
};

// Whether training shapes can be laid over a new one: models of rigs with an orientation keep their places.
bool can_be_laid_over(const LandmarkModel& model);

// frame: see features_of. exemplars, starts: so many at most.
ShapeStarts lay_shapes_over(const LandmarkModel& model, const SurfaceAnalysis& analysis, const Matrix3& frame,
                            size_t exemplars, size_t starts, const Execution& execution);

}  // namespace focal
