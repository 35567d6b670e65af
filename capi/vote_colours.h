// Vote maps as vertex colours, to look at.
#pragma once
#include "base/matrix.h"

namespace focal {

// The hue of one landmark or part.
Eigen::RowVector3f label_colour(int32_t label);

// votes: landmarks x vertices, 0..1. Returns vertices x 3, linear RGB: grey where nothing is voted for,
// towards the hue of the landmark with the strongest vote otherwise; neighbouring landmark numbers get
// distant hues.
RowMatrixf vote_colours(const RowMatrixf& votes);

}  // namespace focal
