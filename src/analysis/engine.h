// The expensive operations on one analysed surface: on the CPU by the stages of this library, on a device by
// its module. Results agree to rounding; tests/compute compares them.
#pragma once
#include <memory>
#include <vector>

#include "base/matrix.h"
#include "base/parallel.h"
#include "compute/backend.h"
#include "model/landmark_model.h"
#include "spectrum/eigenbasis.h"
#include "spectrum/functional_map.h"

namespace focal {

// Seconds of wall time a stage; load, repair and proxy are filled by whoever does them.
struct StageSeconds {
  double load = 0, repair = 0, proxy = 0, spectrum = 0, descriptors = 0, geodesics = 0, forest = 0, vote = 0,
         constellation = 0, refine = 0, total = 0;
};

struct SurfaceAnalysis;

// Immutable, thread-safe. A device's engine throws BackendFailure; the caller then restarts on the CPU
// (with_fallback).
class Engine {
 public:
  virtual ~Engine() = default;

  virtual Eigenbasis spectrum(const SurfaceAnalysis& analysis, const EigenParams& params,
                              const Execution& execution) const = 0;
  // Descriptors of the vertices; called after the spectrum, which computed the basis.
  virtual RowMatrixf descriptors(const SurfaceAnalysis& analysis, const Eigenbasis& basis,
                                 const std::vector<int32_t>& vertices, const Execution& execution) const = 0;
  // Votes of the first samples, one row of features each: vertices x landmarks.
  virtual RowMatrixf votes(const SurfaceAnalysis& analysis, const LandmarkModel& model,
                           const RowMatrixf& features, const Execution& execution,
                           StageSeconds& seconds) const = 0;
  // Peaks of these votes, which must be the last computed: up to `count` vertices per landmark, the best
  // first, each outside the connected balls of this radius around the better ones.
  virtual std::vector<std::vector<int32_t>> peaks(const SurfaceAnalysis& analysis, const RowMatrixf& votes,
                                                  int32_t count, double radius,
                                                  const Execution& execution) const = 0;
  // See analysis/isoline_votes.h.
  virtual RowMatrixf isoline_votes(const SurfaceAnalysis& analysis, const RowMatrixf& radii,
                                   const Execution& execution) const = 0;
  // See spectrum/functional_map.h. `to` holds the eigenfunctions of the analysed surface.
  virtual FunctionalMap zoom_out(const SpectralSamples& from, const SpectralTargets& to,
                                 PlacesBetween initial, const MapParams& params) const = 0;

  virtual bool is_device() const = 0;
  // What a device did since the last call, by its own clock; at most 64 stages.
  virtual std::vector<ComputeStage> stages() const { return {}; }
};

// A single engine for all surfaces.
std::shared_ptr<const Engine> cpu_engine();

}  // namespace focal
