// Possible orientations of a body in its file's coordinates.
#pragma once
#include <limits>
#include <vector>

#include "analysis/surface_analysis.h"
#include "model/landmark_model.h"

namespace focal {

struct Heading {
  Matrix3 frame = Matrix3::Identity();  // see features_of
  double penalty = 0;                   // energy added before anything is known about the body
  // How much larger the penalty of the opposite heading is; infinite where the heading is known.
  double advantage = std::numeric_limits<double>::infinity();
};

// Headings in this order: as the training shapes stand; facing backwards, which looks most similar to it;
// then the headings and up axes that two forests estimate. One forest knows only features that no motion
// changes, the other also the height; both predict position and normal of such points on the training shapes.
// A model without an orientation, and one for meshes of a known orientation, has one heading.
std::vector<Heading> headings_to_try(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                     DetectParams::Orientation orientation);

// Trains the two forests on a few samples of each mesh.
void learn_orientation(LandmarkModel& model, const std::vector<const SurfaceAnalysis*>& meshes,
                       const Execution& execution);

}  // namespace focal
