// Landmark positions from whole training shapes overlaid on a new one. Votes judge each place on its own: the
// brim of a large hat is where most bodies have their arms. An overlaid training shape with such a head
// resolves this.
#pragma once
#include <vector>

#include "analysis/surface_analysis.h"
#include "model/landmark_model.h"

namespace focal {

// Mean of weighted points, and their spread along each axis.
struct Extents {
  Vector3 mean, deviation;
};
Extents extents_of(const MatrixX3& points, const Vector& weight);

// Scale of one shape's points along each axis, so that they spread as those of the other; the scales are
// limited to a similar range.
Vector3 scale_onto(const Extents& shape, const Extents& other);

struct ShapeStarts {
  std::vector<int32_t> exemplars;  // the training shapes that cover it best, best first
  double apart = 0;                // of the best: mean distance between the shapes, both directions
  // Places of the landmarks, by the first few of these; triangle -1: the shape has no such landmark.
  std::vector<std::vector<SurfacePoint>> places;
};

// Whether training shapes can be overlaid on a new one: only models of rigs with an orientation store
// positions.
bool can_be_laid_over(const LandmarkModel& model);

// frame: see features_of. exemplars, starts: maximum numbers.
ShapeStarts lay_shapes_over(const LandmarkModel& model, const SurfaceAnalysis& analysis, const Matrix3& frame,
                            size_t exemplars, size_t starts, const Execution& execution);

}  // namespace focal
