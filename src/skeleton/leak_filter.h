// Takes weights of far joints off the vertices of a surface.
#pragma once
#include <vector>

#include "analysis/surface_analysis.h"
#include "skeleton/taught_weights.h"

namespace focal {

// What the training shapes' own weights keep to.
struct WeightHabits {
  std::vector<float>
      reach;            // per joint: how far from its bones it moves what, of sqrt(area) of the character
  RowMatrixf together;  // joints x joints: 1 where two of them move one place
};

// posed: the points of each map's shape, their joints at those of the skeleton.
WeightHabits habits_of(const Teachers& teachers, const PlacedSkeleton& skeleton,
                       const std::vector<MatrixX3>& posed);

// Each row keeps the joints near its vertex, scaled to sum 1; one that would lose all takes the nearest bone's.
void drop_leaks(RowMatrixf& weights, const SurfaceAnalysis& analysis, const PlacedSkeleton& skeleton,
                const WeightHabits& habits);

}  // namespace focal
