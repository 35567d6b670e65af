#include "analysis/surface_analysis.h"

#include <algorithm>
#include <cmath>

#include "analysis/device_engine.h"
#include "base/random.h"
#include "base/stopwatch.h"
#include "descriptors/bulge.h"
#include "descriptors/descriptor.h"
#include "spectrum/eigenbasis.h"

namespace focal {
namespace {

constexpr int lanes = Distance::lanes;
constexpr int64_t kept_entries = int64_t{1} << 25;     // 64 MB
constexpr int64_t portion_entries = int64_t{1} << 24;  // per portion that is recomputed

int32_t sample_count(int32_t vertices, const AnalysisParams& params) {
  const auto wanted = static_cast<int32_t>(std::lround(params.sampling_rate * vertices));
  // On a tiny mesh a tenth of the vertices is too few for votes: use at least 100, or all of them.
  return std::min({std::max(wanted, 100), vertices, params.max_samples});
}

// Computes blocks [first, first + count) of the samples' distances, for `used` samples.
SampleDistances compute_distances(const SurfaceAnalysis& analysis, int32_t first, int32_t used,
                                  const Execution& execution) {
  SampleDistances result;
  result.vertices = analysis.metric->vertex_count();
  result.step = analysis.metric->distance_bound() / 65535;
  const size_t block = static_cast<size_t>(result.vertices) * lanes;
  result.steps.resize((used + lanes - 1) / lanes * block);
  const auto to_steps = static_cast<float>(1 / result.step);
  analysis.metric->for_each_block(
      std::span(analysis.samples).subspan(first, used), execution,
      [&](int64_t at, int32_t, const float* distances) {
        uint16_t* out = &result.steps[at / lanes * block];
        for (size_t i = 0; i < block; ++i)
          out[i] =
              static_cast<uint16_t>(static_cast<int32_t>(std::min(distances[i] * to_steps + 0.5f, 65535.0f)));
      });
  return result;
}

EigenParams eigen_params(const AnalysisParams& params) {
  EigenParams eigen;
  eigen.count = params.eigenpair_count;
  eigen.method = EigenMethod::chebyshev;
  eigen.tolerance = 1e-7;  // 1e-5 suffices for the signatures; maps amplify the remaining error
  return eigen;
}

// Vertices are numbered region by region: every k-th is spread over all regions.
DescribedVertices describe_spread(const SurfaceAnalysis& analysis, const Eigenbasis& basis,
                                  const Execution& execution) {
  DescribedVertices result;
  if (analysis.params.max_described == 0) return result;
  const int32_t n = analysis.surface().vertex_count();
  const int32_t stride = (n + analysis.params.max_described - 1) / analysis.params.max_described;
  for (int32_t v = 0; v < n; v += stride) result.vertices.push_back(v);
  result.descriptors = analysis.engine->descriptors(analysis, basis, result.vertices, execution);
  return result;
}

}  // namespace

AnalysisParams analysis_params_of(const TrainParams& trained) {
  AnalysisParams params;
  params.proxy_vertices = trained.proxy_vertices;
  params.eigenpair_count = trained.eigenpair_count;
  params.paper_exact = trained.preset == Preset::paper;
  params.descriptor = trained.descriptor, params.distance = trained.distance;
  return params;
}

SurfaceAnalysis analyse_surface(std::shared_ptr<const PreparedMesh> mesh, const AnalysisParams& params,
                                const Execution& execution) {
  SurfaceAnalysis result;
  Stopwatch watch;
  result.params = params;
  result.proxy = make_proxy(std::move(mesh), params.proxy_vertices, execution, !params.paper_exact);
  result.proxy_seconds = watch.lap();
  execution.check_cancelled();
  if (!open_on_device(result, execution)) make_solvers(result, execution);
  result.geodesic_seconds = watch.lap();
  execution.check_cancelled();
  const Eigenbasis basis = result.engine->spectrum(result, eigen_params(params), execution);
  execution.check_cancelled();
  result.eigenfunctions = basis.Phi.cast<float>();
  result.spectrum_seconds = watch.lap();
  Random random(params.seed, params.stream);
  const int32_t n = result.surface().vertex_count(), count = sample_count(n, params);
  result.samples = sample_without_replacement(random, n, count);
  result.described = describe_spread(result, basis, execution);
  const bool all_described = static_cast<int32_t>(result.described.vertices.size()) == n;
  result.descriptors = all_described ? RowMatrixf(result.described.descriptors(result.samples, Eigen::all))
                                     : result.engine->descriptors(result, basis, result.samples, execution);
  describe_relief(result, execution);
  result.descriptor_seconds = watch.lap();
  return result;
}

void make_surface_operators(SurfaceAnalysis& analysis, const Bridges& bridges, const Execution& execution) {
  analysis.operators = make_operators(analysis.surface(), bridges, !analysis.params.paper_exact);
  execution.check_cancelled();
}

void make_solvers(SurfaceAnalysis& analysis, const Execution& execution) {
  const Bridges bridges = bridges_of(*analysis.proxy.coarse);
  make_surface_operators(analysis, bridges, execution);
  analysis.metric = distance_kinds()[analysis.params.distance].make(
      {analysis.surface(), bridges, analysis.operators, analysis.params.paper_exact}, execution);
}

void describe_relief(SurfaceAnalysis& analysis, const Execution& execution) {
  analysis.normals = area_normals(analysis.surface());
  analysis.normals.rowwise().normalize();
  if (!analysis.normals.allFinite())
    analysis.normals = analysis.normals.array().isFinite().select(analysis.normals, 0);
  if (!analysis.params.paper_exact)
    analysis.bulge = bulge(analysis.surface(), analysis.normals, analysis.operators.mass, execution);
}

void keep_distances(SurfaceAnalysis& analysis, const Execution& execution) {
  const auto samples = static_cast<int32_t>(analysis.samples.size());
  if (!analysis.distances.steps.empty() || int64_t{samples} * analysis.metric->vertex_count() > kept_entries)
    return;
  Stopwatch watch;
  analysis.distances = compute_distances(analysis, 0, samples, execution);
  analysis.geodesic_seconds += watch.lap();
}

void for_each_portion(const SurfaceAnalysis& analysis, int32_t count, const Execution& execution,
                      const DistanceSink& sink) {
  if (!analysis.distances.steps.empty()) return sink(0, count, analysis.distances);
  // Depends on the mesh alone, so that memory and results do not depend on the number of threads.
  const int64_t blocks = std::max<int64_t>(portion_entries / lanes / analysis.metric->vertex_count(), 4);
  for (int32_t first = 0; first < count; first += static_cast<int32_t>(blocks) * lanes) {
    const int32_t used = std::min(static_cast<int32_t>(blocks) * lanes, count - first);
    sink(first, used, compute_distances(analysis, first, used, execution));
    execution.report(static_cast<double>(first + used) / count);
  }
}

}  // namespace focal
