#include <algorithm>

#include "analysis/engine.h"
#include "analysis/isoline_votes.h"
#include "analysis/leaf_votes.h"
#include "analysis/surface_analysis.h"
#include "base/stopwatch.h"
#include "descriptors/descriptor.h"
#include "vote/peaks.h"
#include "vote/vote.h"

namespace focal {
namespace {

constexpr int32_t samples_at_once = 128;  // samples whose tables are in memory; a multiple of 32

class CpuEngine final : public Engine {
 public:
  Eigenbasis spectrum(const SurfaceAnalysis& analysis, const EigenParams& params,
                      const Execution& execution) const override {
    return eigenbasis(analysis.operators.L, analysis.operators.mass, params, execution,
                      analysis.metric->symbolic());
  }

  RowMatrixf descriptors(const SurfaceAnalysis& analysis, const Eigenbasis& basis,
                         const std::vector<int32_t>& vertices, const Execution& execution) const override {
    const DescriptorKind& kind = descriptor_kinds()[analysis.params.descriptor];
    return kind.describe({analysis.surface(), analysis.operators, basis}, vertices, execution).cast<float>();
  }

  RowMatrixf votes(const SurfaceAnalysis& analysis, const LandmarkModel& model, const RowMatrixf& features,
                   const Execution& execution, StageSeconds& seconds) const override {
    const auto L = static_cast<int32_t>(model.landmark_names.size());
    RowMatrixf votes = RowMatrixf::Zero(analysis.metric->vertex_count(), VoteTables::padded(L));
    Stopwatch watch;
    const LeafVotes leaf_votes(model, features, execution);
    seconds.forest += watch.lap();
    for_each_portion(analysis, static_cast<int32_t>(features.rows()), execution,
                     [&](int32_t first, int32_t used, const SampleDistances& portion) {
                       seconds.geodesics += watch.lap();
                       for (int32_t from = 0; from < used; from += samples_at_once) {
                         const int32_t some = std::min(samples_at_once, used - from);
                         const VoteTables tables = leaf_votes.tables(first + from, some, execution);
                         seconds.forest += watch.lap();
                         add_distribution_votes(tables, some,
                                                {portion.steps.data(), portion.step, portion.vertices}, from,
                                                votes, execution);
                         seconds.vote += watch.lap();
                       }
                     });
    return votes.leftCols(L);
  }

  std::vector<std::vector<int32_t>> peaks(const SurfaceAnalysis& analysis, const RowMatrixf& votes,
                                          int32_t count, double radius,
                                          const Execution& execution) const override {
    const auto surroundings = [&](int32_t v) {
      return connected_ball(analysis.operators.L, analysis.surface().positions, v, radius);
    };
    return find_peaks(votes, static_cast<int32_t>(votes.cols()), count, 0, surroundings, execution);
  }

  RowMatrixf isoline_votes(const SurfaceAnalysis& analysis, const RowMatrixf& radii,
                           const Execution& execution) const override {
    return focal::isoline_votes(analysis, radii, execution);
  }

  FunctionalMap zoom_out(const SpectralSamples& from, const SpectralTargets& to, PlacesBetween initial,
                         const MapParams& params) const override {
    return focal::zoom_out(from, to, std::move(initial), params);
  }

  bool is_device() const override { return false; }
};

}  // namespace

std::shared_ptr<const Engine> cpu_engine() {
  static const CpuEngine engine;
  return {std::shared_ptr<void>(), &engine};  // no owner: no allocation, no reference count
}

}  // namespace focal
