// Finds the separate maxima of the vote maps.
#pragma once
#include <functional>
#include <vector>

#include "base/matrix.h"
#include "base/parallel.h"

namespace focal {

// The vertices too near to a peak to be another peak, including the peak itself.
using Surroundings = std::function<std::vector<int32_t>(int32_t vertex)>;

// Up to `count` vertices per landmark, best first, each outside the surroundings of the earlier ones and with
// at least `floor` of the best vote. votes: vertices x columns, of which the first `landmarks` are used.
std::vector<std::vector<int32_t>> find_peaks(const RowMatrixf& votes, int32_t landmarks, int32_t count,
                                             double floor, const Surroundings& surroundings,
                                             const Execution& execution);

}  // namespace focal
