// The separate maxima of the vote maps.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "base/matrix.h"

namespace focal {

// Distances (sources x vertices) from several vertices at once.
using DistanceFields = std::function<RowMatrixf(std::span<const int32_t> vertices)>;

// Up to `count` vertices a landmark, best first, each at least `separation` from the earlier ones and with a vote of at
// least `floor` of the best. votes: vertices x landmarks.
std::vector<std::vector<int32_t>> find_peaks(const RowMatrixf& votes, int32_t count, double separation,
                                             double floor, const DistanceFields& fields);

}  // namespace focal
