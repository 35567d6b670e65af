#include "landmarks/surface_analysis.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/stopwatch.h"
#include "descriptors/descriptor.h"
#include "spectrum/eigenbasis.h"

namespace focal {
namespace {

int32_t sample_count(int32_t vertices, const AnalysisParams& params) {
  const auto wanted = static_cast<int32_t>(std::lround(params.sampling_rate * vertices));
  // On a tiny mesh a tenth of the vertices is too few to vote: at least 100, or all of them.
  return std::min({std::max(wanted, 100), vertices, params.max_samples});
}

}  // namespace

SurfaceAnalysis analyse_surface(const PreparedMesh& mesh, const AnalysisParams& params,
                                const Execution& execution) {
  SurfaceAnalysis result;
  Stopwatch watch;
  result.operators = make_operators(mesh.surface, mesh.bridges);
  execution.check_cancelled();
  result.heat = HeatMethod(mesh.surface, result.operators, execution, 1, params.keep_negative_heat);
  result.geodesic_seconds = watch.lap();
  execution.check_cancelled();
  EigenParams eigen;
  eigen.count = params.eigenpair_count;
  eigen.method = EigenMethod::chebyshev;
  eigen.tolerance = 1e-6;  // far below what the signatures, and a forest's thresholds, can tell
  const Eigenbasis basis = eigenbasis(result.operators.L, result.operators.mass, eigen, execution);
  result.spectrum_seconds = watch.lap();
  Random random(params.seed, params.stream);
  const int32_t n = mesh.surface.vertex_count();
  result.samples = sample_without_replacement(random, n, sample_count(n, params));
  result.descriptors = si_hks(basis, result.operators.area, result.samples).cast<float>();
  result.descriptor_seconds = watch.lap();
  return result;
}

}  // namespace focal
