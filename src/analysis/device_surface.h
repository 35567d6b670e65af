// One analysed surface on a GPU, with the operations that analysis and detection use. All functions throw
// BackendFailure.
#pragma once
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/lazy.h"
#include "base/matrix.h"
#include "compute/backend.h"
#include "geodesics/distance.h"
#include "mesh/prepare.h"
#include "model/landmark_model.h"
#include "operators/operators.h"
#include "spectrum/eigenbasis.h"
#include "spectrum/functional_map.h"

namespace focal {

// Thread-safe: one call at a time. Closing the surface frees the device's memory; no operation may be called
// afterwards.
class DeviceSurface {
 public:
  DeviceSurface(const Backend& backend, const MatrixX3& positions, const Operators& operators,
                double heat_time, bool keep_negative_heat);
  ~DeviceSurface() { close(); }
  DeviceSurface(const DeviceSurface&) = delete;

  void close();
  bool is_open() const;

  Eigenbasis spectrum(const EigenParams& params) const;
  // SI-HKS of the given vertices, after the spectrum; lambda: its eigenvalues.
  RowMatrixf si_hks(const Vector& lambda, double area, std::span<const int32_t> vertices) const;
  // scale x (squared eigenfunctions of the given vertices) x weights; weights: eigenpairs x components.
  RowMatrixf spectral_signatures(const Matrix& weights, double scale,
                                 std::span<const int32_t> vertices) const;
  // out: vertices x sources.
  void distances(std::span<const Distance::Source> sources, float* out) const;
  // Votes of the samples, one row of descriptors each: vertices x VoteTables::padded(landmarks).
  RowMatrixf votes(const LandmarkModel& model, std::span<const int32_t> samples,
                   const Eigen::Ref<const RowMatrixf>& descriptors) const;
  // Like find_peaks with connected balls as surroundings, on the last votes; once per votes.
  std::vector<std::vector<int32_t>> peaks(int32_t landmarks, int32_t count, double radius) const;
  // Votes of the samples along isolines at radii (samples x columns, relative to a sample's largest distance)
  // with weight exp(-mu radius^2), averaged over a neighbourhood given relative to each vertex' own largest
  // distance: vertices x columns.
  RowMatrixf isoline_votes(std::span<const int32_t> samples, const RowMatrixf& radii, double mu,
                           const Edges& edges, float neighbourhood) const;
  // Like zoom_out; to.Phi must be the same in every call.
  FunctionalMap zoom_out(const SpectralSamples& from, const SpectralTargets& to, PlacesBetween initial,
                         const MapParams& params) const;
  // The stages that the device has run since the last call, timed by its own clock; at most 64.
  std::vector<ComputeStage> stages() const;

 private:
  RowMatrixf signatures(const ComputeSignature& signature, int32_t components,
                        std::span<const int32_t> vertices) const;

  const Backend& backend_;
  int32_t vertices_;
  mutable std::mutex mutex_;
  void* surface_ = nullptr;
};

// The heat method on the device. Once the surface is closed, on the CPU, prepared at the first call.
class DeviceDistance final : public Distance {
 public:
  DeviceDistance(std::shared_ptr<const PreparedMesh> mesh, const Operators& operators,
                 bool keep_negative_heat, const Backend& backend);
  const char* warning() const override { return warning_; }
  void solve_block(std::span<const Source> sources, float* out, const Execution& execution) const override;
  const std::shared_ptr<DeviceSurface>& surface() const { return surface_; }

 private:
  std::shared_ptr<const PreparedMesh> mesh_;
  Operators operators_;
  bool keep_negative_heat_;
  const char* warning_ = nullptr;
  std::shared_ptr<DeviceSurface> surface_;
  Lazy<std::unique_ptr<const Distance>> on_cpu_;
};

}  // namespace focal
