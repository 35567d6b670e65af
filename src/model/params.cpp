#include "model/params.h"

namespace focal {

TrainParams TrainParams::from_preset(Preset preset) {
  TrainParams params;
  params.preset = preset;
  if (preset == Preset::paper)
    params.eigenpair_count = 200, params.proxy_vertices = 0, params.sampling_rate = 0.5,
    params.bulge = params.oriented = false;
  return params;  // the other numbers of Xia et al. 2016, Section 5, apply to both presets
}

double sampling_rate_of(const DetectParams& detect, const TrainParams& trained) {
  if (detect.sampling_rate > 0) return detect.sampling_rate;
  if (trained.preset == Preset::paper || trained.proxy_vertices == 0) return 0.1;
  return detect.quality == Quality::best ? 0.4 : 0.2;
}

}  // namespace focal
