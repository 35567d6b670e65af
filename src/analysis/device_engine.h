// The engine of an analysed surface that a device works on.
#pragma once
#include "analysis/engine.h"
#include "analysis/surface_analysis.h"

namespace focal {

// Gives the analysis, whose proxy is there, operators, a metric and an engine on the device of the execution; false, and nothing done, where
// there is no device or the surface does not suit it.
bool open_on_device(SurfaceAnalysis& analysis, const Execution& execution);

// Closes a device's surface and goes on with the CPU: what outlives a call takes no memory of the device, and cannot fail by it.
void leave_device(SurfaceAnalysis& analysis);

}  // namespace focal
