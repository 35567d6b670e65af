// The knobs of training and detection on the command line.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "options.h"

namespace focal_cli {

struct TrainOptions {
  focal_preset preset = FOCAL_PRESET_DEFAULT;
  std::optional<int32_t> trees, eigenpairs, proxy_vertices;
  std::optional<double> sampling_rate;
  focal_descriptor descriptor = FOCAL_DESCRIPTOR_SI_HKS;
  focal_distance distance = FOCAL_DISTANCE_HEAT;
};

void add_train_options(CLI::App& verb, TrainOptions& options);
focal_train_params train_params_of(const TrainOptions& options, const CommonOptions& common);

// Which meshes of a set are taken, and which landmarks are counted.
void add_split_options(CLI::App& verb, std::string& split, size_t& limit, const std::string& what);
void add_subset_option(CLI::App& verb, std::vector<std::string>& subset);

// The knobs of detection that all verbs share which detect.
struct DetectionOptions {
  focal_quality quality = FOCAL_QUALITY_BEST;
  focal_orientation orientation = FOCAL_ORIENTATION_UPRIGHT;
};

void add_detection_options(CLI::App& verb, DetectionOptions& options);
focal_detect_params detect_params_of(const DetectionOptions& options, const CommonOptions& common);

}  // namespace focal_cli
