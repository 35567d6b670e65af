#include "landmarks/params.h"

namespace focal {

TrainParams TrainParams::from_preset(Preset preset) {
  TrainParams params;
  params.preset = preset;
  return params;  // the numbers of Xia et al. 2016, Section 5, serve both presets
}

}  // namespace focal
