// Combines a placement with the maps from the training shapes: the position of each landmark between its
// votes' place and the transferred ones, and how well they agree.
#pragma once
#include "landmarks/exemplar_maps.h"
#include "landmarks/placement.h"
#include "model/landmark_model.h"

namespace focal {

// Moves each placed landmark to the consensus of its own place and the landmarks transferred from all
// training shapes, and records the agreement in its features. Quality `interactive` uses a few shapes in
// fewer rounds and leaves the features unchanged. The maps of quality `best` are stored in the placement.
void join_transferred_landmarks(const LandmarkModel& model, const SurfaceAnalysis& analysis, Quality quality,
                                Placement& placement, const Execution& execution);

// Fit of maps of training shapes, started from the placement.
struct MapFit {
  double residual = 0, bulge_agreement = 0;  // means over the maps
};
// From coarse maps. shapes: use only those of the exemplars whose first steps fit best; 0: all.
MapFit quick_map_fit(const LandmarkModel& model, const SurfaceAnalysis& analysis, const Placement& placement,
                     int32_t shapes, const Execution& execution);

}  // namespace focal
