// The engine of a surface that is analysed on a device.
#pragma once
#include "analysis/engine.h"
#include "analysis/surface_analysis.h"

namespace focal {

// Gives an analysis with a proxy its operators, metric and an engine on the device of the execution. Returns
// false and changes nothing where there is no device or it does not support the surface.
bool open_on_device(SurfaceAnalysis& analysis, const Execution& execution);

// Closes the device's surface and continues on the CPU, so that objects that outlive the call occupy no
// device memory and cannot fail because of the device.
void leave_device(SurfaceAnalysis& analysis);

}  // namespace focal
