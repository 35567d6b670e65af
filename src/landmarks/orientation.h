// Which way a body may stand in its file's coordinates.
#pragma once
#include <vector>

#include "landmarks/model_parts.h"
#include "landmarks/surface_analysis.h"

namespace focal {

struct Heading {
  Matrix3 frame = Matrix3::Identity();  // see features_of
  double penalty = 0;                   // energy that it costs before anything is seen of the body
};

// The orientation of the training shapes first; then the same turned to face backwards, which looks most like it; then those of the 24
// turns by right angles in which the forest's trees agree clearly better. A model without an orientation has one heading.
std::vector<Heading> headings_to_try(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                     DetectParams::Orientation orientation, const Execution& execution);

}  // namespace focal
