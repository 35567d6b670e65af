// One analysed surface on a GPU: what analysis and detection ask of it. Everything here throws BackendFailure.
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

// Thread-safe: one call at a time. The device's memory is free again once it is closed; nothing may be asked then.
class DeviceSurface {
 public:
  DeviceSurface(const Backend& backend, const MatrixX3& positions, const Operators& operators,
                double heat_time, bool keep_negative_heat);
  ~DeviceSurface() { close(); }
  DeviceSurface(const DeviceSurface&) = delete;

  void close();
  bool is_open() const;

  Eigenbasis spectrum(const EigenParams& params) const;
  // SI-HKS of some vertices, after the spectrum, whose eigenvalues these are.
  RowMatrixf si_hks(const Vector& lambda, double area, std::span<const int32_t> vertices) const;
  // scale times the squared eigenfunctions of some vertices times weights: eigenpairs x components.
  RowMatrixf spectral_signatures(const Matrix& weights, double scale,
                                 std::span<const int32_t> vertices) const;
  // out: vertices x sources.
  void distances(std::span<const Distance::Source> sources, float* out) const;
  // Votes of the samples, one row of descriptors each: vertices x VoteTables::padded(landmarks).
  RowMatrixf votes(const LandmarkModel& model, std::span<const int32_t> samples,
                   const Eigen::Ref<const RowMatrixf>& descriptors) const;
  // As find_peaks with connected balls as surroundings, of the last votes, once.
  std::vector<std::vector<int32_t>> peaks(int32_t landmarks, int32_t count, double radius) const;
  // Votes of the samples along isolines at radii (samples x columns, shares of a sample's largest distance) with exp(-mu
  // radius^2), averaged over a share of a vertex' own largest distance: vertices x columns.
  RowMatrixf isoline_votes(std::span<const int32_t> samples, const RowMatrixf& radii, double mu,
                           const Edges& edges, float neighbourhood) const;
  // As zoom_out; to.Phi must be the same at every call.
  FunctionalMap zoom_out(const SpectralSamples& from, const SpectralTargets& to, PlacesBetween initial,
                         const MapParams& params) const;
  // What the device did since the last time, by its own clock; at most 64 stages.
  std::vector<ComputeStage> stages() const;

 private:
  RowMatrixf signatures(const ComputeSignature& signature, int32_t components,
                        std::span<const int32_t> vertices) const;

  const Backend& backend_;
  int32_t vertices_;
  mutable std::mutex mutex_;
  void* surface_ = nullptr;
};

// The heat method on the device; once the surface is closed, on the CPU, prepared when first asked.
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
