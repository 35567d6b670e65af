// Which way a body may stand in its file's coordinates.
#pragma once
#include <vector>

#include "analysis/surface_analysis.h"
#include "model/landmark_model.h"

namespace focal {

struct Heading {
  Matrix3 frame = Matrix3::Identity();  // see features_of
  double penalty = 0;                   // energy that it costs before anything is seen of the body
};

// As the training shapes stand first, then facing backwards, which looks most like it, then where two forests expect the body to face
// and its up axis to lie: one knows only what no motion changes of a point, the other also its height, and both where such points
// lie and face on the training shapes. A model without an orientation, and one for meshes that stand in a
// known way, has one heading.
std::vector<Heading> headings_to_try(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                     DetectParams::Orientation orientation);

// Learns the two forests from a few samples of each mesh.
void learn_orientation(LandmarkModel& model, const std::vector<const SurfaceAnalysis*>& meshes,
                       const Execution& execution);

}  // namespace focal
