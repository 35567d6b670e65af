// Number and order of the features per sample for the forest of preset `default`. See landmarks/features.h.
#pragma once
#include <cstdint>

#include "descriptors/bulge.h"
#include "model/params.h"

namespace focal {

// A split tries a few components drawn at random from all. Groups of few components are repeated so that they
// are drawn often enough.
inline constexpr int32_t bulge_copies = 2, frame_copies = 3, frame_components = 6, upright_components = 4;
inline constexpr auto bulge_components = static_cast<int32_t>(bulge_radii.size());

int32_t feature_count(const TrainParams& params);
int32_t invariant_feature_count(const TrainParams& params);
int32_t upright_feature_count(const TrainParams& params);

// A number of placed_features with the precision of the file: a multiple of 1 / 4000 within -8..8. Training
// uses no higher precision.
uint16_t place_to_file(float value);
float place_from_file(uint16_t value);

}  // namespace focal
