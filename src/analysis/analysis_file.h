// Serialises the expensive parts of an analysis. docs/model-format.md describes the file.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "analysis/surface_analysis.h"

namespace focal {

std::vector<std::byte> serialise(const SurfaceAnalysis& analysis);

// mesh: the one that was analysed. Operators and factors are recomputed, which takes little time. Throws
// invalid_file (also for a mesh other than that of the analysis) and unsupported_version.
SurfaceAnalysis parse_analysis(std::span<const std::byte> file, std::shared_ptr<const PreparedMesh> mesh,
                               const Execution& execution);

}  // namespace focal
