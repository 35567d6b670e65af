// All parameters of training and detection, set from a preset.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace focal {

enum class Preset : int32_t { default_preset = 0, paper = 1 };
enum class Quality : int32_t { best = 0, interactive = 1 };

struct TrainParams {
  Preset preset = Preset::default_preset;
  int32_t eigenpair_count = 128;  // as accurate as 200 on proxies
  int32_t tree_count = 30;
  int32_t min_leaf_samples = 5;  // default: smallest leaf; paper: nodes of fewer than twice this are leaves
  int32_t components_per_split = 5;  // random descriptor components tried at each split
  int32_t proxy_vertices = 3500;     // shapes are analysed on proxies of about this size; 0: without
  double sampling_rate = 1;          // share of the analysed vertices of each training shape
  int32_t max_samples_per_shape = 6250;
  // Corrupted copies per training shape: one noisy with holes, the others with a part cut off.
  int32_t augmented_copies = 3;
  bool learns_confidence = true;  // by cross-fitting, most of the training time
  uint64_t seed = 0;
  bool bulge = true;          // preset default: bulge features for the forest
  bool oriented = true;       // likewise, of rigged shapes: position and normal features, +Y up and +Z front
  bool finds_heading = true;  // with `oriented`: the orientation of a mesh is unknown and must be found
  int32_t descriptor = 0;     // number in descriptors/descriptor.h
  int32_t distance = 0;       // number in geodesics/distance.h
  static TrainParams from_preset(Preset preset);
};

struct DetectParams {
  double sampling_rate = 0;  // share of the analysed vertices; 0: chosen for the model's preset
  int32_t max_samples = 1250;
  int32_t peaks_per_landmark = 8;
  double found_confidence = 0.5;    // below: uncertain
  double absent_confidence = 0.05;  // below: absent
  Quality quality = Quality::best;
  // For models with a learned orientation: how the mesh may be rotated relative to it. With `upright`, other
  // headings and up axes are tried where the mesh does not fit as it is, with a penalty; with `any` all
  // orientations are equal.
  enum class Orientation : int32_t { upright = 0, any = 1 } orientation = Orientation::upright;
  bool keep_votes = true;  // keep the vote maps in the detection
  uint64_t seed = 1;
  // Known landmarks, one entry per landmark, on the full surface: they stay in place, and the others are
  // chosen to fit them. Empty: none.
  std::vector<std::optional<SurfacePoint>> fixed = {};
};

// The requested rate, or the default of the preset: Xia et al. 2016, Section 5, or as measured on proxies.
double sampling_rate_of(const DetectParams& detect, const TrainParams& trained);

}  // namespace focal
