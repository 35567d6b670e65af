// Removes weights of distant joints from the vertices of a surface.
#pragma once
#include <vector>

#include "analysis/surface_analysis.h"
#include "skeleton/taught_weights.h"

namespace focal {

// Properties of the training shapes' own weights.
struct WeightHabits {
  // Per joint the largest distance from its bones to vertices that it moves, relative to sqrt(area) of the
  // character.
  std::vector<float> reach;
  RowMatrixf together;  // joints x joints: 1 where two of them move the same vertex
};

// posed: the points of each map's shape, with their joints moved to those of the skeleton.
WeightHabits habits_of(const Teachers& teachers, const PlacedSkeleton& skeleton,
                       const std::vector<MatrixX3>& posed);

// Keeps in each row the joints near its vertex, scaled to sum 1; a row that would become empty gets the joint
// of the nearest bone.
void drop_leaks(RowMatrixf& weights, const SurfaceAnalysis& analysis, const PlacedSkeleton& skeleton,
                const WeightHabits& habits);

}  // namespace focal
