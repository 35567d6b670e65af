// Every knob of training and detection, filled from a preset.
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
  int32_t eigenpair_count = 128;  // measured as good as 200 on proxies
  int32_t tree_count = 30;
  int32_t min_leaf_samples = 5;  // default: smallest leaf; paper: a node of fewer than twice that is a leaf
  int32_t components_per_split = 5;  // random descriptor components tried at each split
  int32_t proxy_vertices = 3500;  // shapes are analysed on proxies of about so many vertices; 0: as they are
  double sampling_rate = 1;       // of the vertices analysed of each training shape
  int32_t max_samples_per_shape = 6250;
  int32_t augmented_copies =
      3;  // of every training shape: one noisy with holes, the others with a part cut off
  bool learns_confidence = true;  // by cross-fitting, the longer part; a model without has no say on it
  uint64_t seed = 0;
  bool bulge = true;          // preset default: the forest knows how the surface bulges
  bool oriented = true;       // likewise, of rigged shapes: where a point lies and faces, +Y up and +Z front
  bool finds_heading = true;  // where oriented: which way a mesh stands is not known beforehand
  int32_t descriptor = 0;     // number in descriptors/descriptor.h
  int32_t distance = 0;       // number in geodesics/distance.h
  static TrainParams from_preset(Preset preset);
};

struct DetectParams {
  double sampling_rate = 0;  // of the vertices analysed; 0: as suits the model's preset
  int32_t max_samples = 1250;
  int32_t peaks_per_landmark = 8;
  double found_confidence = 0.5;    // below: uncertain
  double absent_confidence = 0.05;  // below: absent
  Quality quality = Quality::best;
  // Of models that learned an orientation: how far the mesh may be turned from it. With `upright` headings and axes that differ are
  // tried where the mesh does not fit as it stands, and cost something; with `any_way` they are all alike.
  enum class Orientation : int32_t { upright = 0, any_way = 1 } orientation = Orientation::upright;
  bool keep_votes = true;  // keep the vote maps in the detection
  uint64_t seed = 1;
  // Places that are known, one a landmark, on the full surface: they stay, and the others are chosen to suit them. Empty: none.
  std::vector<std::optional<SurfacePoint>> fixed = {};
};

// The rate asked for, or what suits the preset: Xia et al. 2016, Section 5, or as measured on proxies.
double sampling_rate_of(const DetectParams& detect, const TrainParams& trained);

}  // namespace focal
