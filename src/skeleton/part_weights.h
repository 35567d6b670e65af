// Transfers weights from the analysed surface to the caller's own vertices, part by part.
#pragma once
#include "skeleton/character_rig.h"
#include "skeleton/taught_weights.h"

namespace focal {

// Each source vertex of the rig gets the weights of the nearest point with a similar normal. Vertices of
// different parts at one position get the same weights; but a small separate part attached to one or two
// bones (a hat, an eye, a shoulder plate) is rigid: all its vertices have the same weights. most: influences
// of one vertex, 1 to 8.
void put_influences_by_parts(const SurfaceWeights& found, const PlacedSkeleton& skeleton,
                             const SurfaceAnalysis& analysis, int32_t most, Rig& rig,
                             const Execution& execution);

}  // namespace focal
