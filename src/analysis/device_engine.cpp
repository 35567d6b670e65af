#include "analysis/device_engine.h"

#include "analysis/device_surface.h"
#include "analysis/isoline_votes.h"
#include "base/stopwatch.h"
#include "descriptors/descriptor.h"

namespace focal {
namespace {

// Limits of the device's dense matrices: more vertices take too much memory, fewer are not worth the
// overhead.
constexpr int32_t min_vertices = 512, max_vertices = 12500;

class DeviceEngine final : public Engine {
 public:
  explicit DeviceEngine(std::shared_ptr<DeviceSurface> surface) : surface_(std::move(surface)) {}

  Eigenbasis spectrum(const SurfaceAnalysis&, const EigenParams& params, const Execution&) const override {
    return surface_->spectrum(params);
  }

  // Descriptors that are not functions of the spectrum are computed on the CPU.
  RowMatrixf descriptors(const SurfaceAnalysis& analysis, const Eigenbasis& basis,
                         const std::vector<int32_t>& vertices, const Execution& execution) const override {
    const DescriptorKind& kind = descriptor_kinds()[analysis.params.descriptor];
    const double area = analysis.operators.area;
    if (analysis.params.descriptor == 0) return surface_->si_hks(basis.lambda, area, vertices);
    if (kind.spectral_weights)
      return surface_->spectral_signatures(kind.spectral_weights(basis.lambda, area), area, vertices);
    return cpu_engine()->descriptors(analysis, basis, vertices, execution);
  }

  // The device computes forest, distances and votes in one call.
  RowMatrixf votes(const SurfaceAnalysis& analysis, const LandmarkModel& model, const RowMatrixf& features,
                   const Execution&, StageSeconds& seconds) const override {
    Stopwatch watch;
    const RowMatrixf votes = surface_->votes(
        model, std::span(analysis.samples).first(static_cast<size_t>(features.rows())), features);
    seconds.vote += watch.lap();
    return votes.leftCols(static_cast<Eigen::Index>(model.landmark_names.size()));
  }

  std::vector<std::vector<int32_t>> peaks(const SurfaceAnalysis&, const RowMatrixf& votes, int32_t count,
                                          double radius, const Execution&) const override {
    return surface_->peaks(static_cast<int32_t>(votes.cols()), count, radius);
  }

  RowMatrixf isoline_votes(const SurfaceAnalysis& analysis, const RowMatrixf& radii,
                           const Execution&) const override {
    return surface_->isoline_votes(analysis.samples, radii, isoline_decay, edges_of(analysis.surface()),
                                   isoline_neighbourhood);
  }

  FunctionalMap zoom_out(const SpectralSamples& from, const SpectralTargets& to, PlacesBetween initial,
                         const MapParams& params) const override {
    return surface_->zoom_out(from, to, std::move(initial), params);
  }

  bool is_device() const override { return true; }
  std::vector<ComputeStage> stages() const override { return surface_->stages(); }
  void close() const { surface_->close(); }

 private:
  std::shared_ptr<DeviceSurface> surface_;
};

}  // namespace

bool open_on_device(SurfaceAnalysis& analysis, const Execution& execution) {
  const int32_t n = analysis.surface().vertex_count();
  if (!execution.backend || analysis.params.distance != 0 || n < min_vertices || n > max_vertices ||
      n < 3 * analysis.params.eigenpair_count)
    return false;
  if (analysis.proxy.coarse->components > 1) return false;  // the device has no bridges between parts
  make_surface_operators(analysis, {}, execution);
  const auto metric = std::make_shared<DeviceDistance>(analysis.proxy.coarse, analysis.operators,
                                                       analysis.params.paper_exact, *execution.backend);
  analysis.metric = metric, analysis.engine = std::make_shared<DeviceEngine>(metric->surface());
  return true;
}

void leave_device(SurfaceAnalysis& analysis) {
  if (analysis.engine->is_device()) static_cast<const DeviceEngine&>(*analysis.engine).close();
  analysis.engine = cpu_engine();
}

}  // namespace focal
