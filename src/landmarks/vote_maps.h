// The vote maps of a detection on the full surface, and as vertex colours.
#pragma once
#include "landmarks/detect.h"

namespace focal {

// Landmarks x vertices of mesh->surface: the votes carried over from the proxy, the largest of each landmark is 1. The detection keeps
// votes.
RowMatrixf full_votes(const Detection& detection, const Execution& execution);

// The hue of one landmark or part; neighbouring numbers get distant hues. Grey for -1.
Eigen::RowVector3f label_colour(int32_t label);

// votes: landmarks x vertices, 0..1. Returns vertices x 3, linear RGB: grey where nothing is voted for,
// towards the hue of the landmark with the strongest vote otherwise.
RowMatrixf vote_colours(const RowMatrixf& votes);

}  // namespace focal
