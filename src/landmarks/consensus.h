// What the maps from the training shapes say of a placement: where between the votes' place and the carried marks each
// landmark lies, and how well they agree.
#pragma once
#include "landmarks/exemplar_maps.h"
#include "landmarks/placement.h"
#include "model/landmark_model.h"

namespace focal {

// Moves each placed landmark to where its own place and the marks carried over from all training shapes agree, and records
// in its features how well they do. Quality `interactive` asks a few shapes in fewer rounds and leaves the features as it is.
// The maps of quality `best` stay in the placement.
void join_transferred_landmarks(const LandmarkModel& model, const SurfaceAnalysis& analysis, Quality quality,
                                Placement& placement, const Execution& execution);

// How well maps of training shapes, started from the placement, fit.
struct MapFit {
  double residual = 0, bulge_agreement = 0;  // means over the maps
};
// Of coarse maps. shapes: only those of its exemplars whose first steps fit best; 0: all.
MapFit quick_map_fit(const LandmarkModel& model, const SurfaceAnalysis& analysis, const Placement& placement,
                     int32_t shapes, const Execution& execution);

}  // namespace focal
