#include "model/feature_layout.h"

#include <algorithm>
#include <cmath>

#include "descriptors/descriptor.h"

namespace focal {
namespace {

constexpr float place_steps = 4000, max_place = 8;

}  // namespace

int32_t feature_count(const TrainParams& params) {
  const int32_t signature = descriptor_kinds()[params.descriptor].dimension;
  if (params.preset == Preset::paper) return signature;
  return signature + (params.bulge ? bulge_copies * bulge_components : 0) +
         (params.oriented ? frame_copies * frame_components : 0);
}

int32_t invariant_feature_count(const TrainParams& params) {
  return descriptor_kinds()[params.descriptor].dimension + bulge_copies * bulge_components;
}

int32_t upright_feature_count(const TrainParams& params) {
  return invariant_feature_count(params) + frame_copies * upright_components;
}

uint16_t place_to_file(float value) {
  return static_cast<uint16_t>(
      std::lround((std::clamp(value, -max_place, max_place) + max_place) * place_steps));
}

float place_from_file(uint16_t value) { return static_cast<float>(value) / place_steps - max_place; }

}  // namespace focal
