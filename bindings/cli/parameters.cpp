// The knobs of training and detection on the command line.
#include "parameters.h"

namespace focal_cli {
namespace {

// A choice among what the library has.
void add_named_choice(CLI::App& verb, const std::string& option, int32_t& value, const std::string& help,
                      uint32_t count, const char* (*name)(int32_t)) {
  std::string words;
  std::map<std::string, int32_t> choices;
  for (int32_t i = 0; i < static_cast<int32_t>(count); ++i) {
    words += (i ? "|" : "") + std::string(name(i));
    choices[name(i)] = i;
  }
  add_choice(verb, option, value, help, words, choices);
}

}  // namespace

void add_train_options(CLI::App& verb, TrainOptions& options) {
  add_choice(verb, "--preset", options.preset, "default: most accurate; paper: exactly as in Xia et al. 2016",
             "default|paper", {{"default", FOCAL_PRESET_DEFAULT}, {"paper", FOCAL_PRESET_PAPER}});
  verb.add_option("--trees", options.trees, "Trees in each forest")
      ->type_name("N")
      ->check(CLI::Range(1, 10000).description(""));
  verb.add_option("--eigenpairs", options.eigenpairs, "Eigenpairs of the Laplacian")
      ->type_name("N")
      ->check(CLI::Range(8, 2000).description(""));
  verb.add_option("--sampling-rate", options.sampling_rate, "Share of each mesh's vertices to learn from")
      ->type_name("X")
      ->check(CLI::Range(1e-6, 1.0).description(""));
  verb.add_option("--proxy", options.proxy_vertices,
                  "Analyse larger meshes on a decimated copy of about N vertices; 0: as they are")
      ->type_name("N")
      ->check(CLI::Range(0, 10000000).description(""));
  add_named_choice(verb, "--descriptor", options.descriptor, "Descriptor of the surroundings of a point",
                   focal_descriptor_count(), focal_descriptor_name);
  add_named_choice(verb, "--distance", options.distance,
                   "Kind of distance; kinds that are not geodesic work only with preset paper",
                   focal_distance_count(), focal_distance_name);
}

focal_train_params train_params_of(const TrainOptions& options, const CommonOptions& common) {
  auto params = initialised(focal_train_params_init);
  check(focal_train_params_set_preset(&params, options.preset));
  params.tree_count = options.trees.value_or(params.tree_count);
  params.eigenpair_count = options.eigenpairs.value_or(params.eigenpair_count);
  params.sampling_rate = options.sampling_rate.value_or(params.sampling_rate);
  params.proxy_vertices = options.proxy_vertices.value_or(params.proxy_vertices);
  params.seed = common.seed.value_or(params.seed);
  params.descriptor = options.descriptor;
  params.distance = options.distance;
  return params;
}

void add_split_options(CLI::App& verb, std::string& split, size_t& limit, const std::string& what) {
  verb.add_option("--split", split, what + ": train, test, extra or all")
      ->type_name("NAME")
      ->capture_default_str();
  verb.add_option("--limit", limit, "Use only the first N meshes")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000000).description(""));
}

void add_subset_option(CLI::App& verb, std::vector<std::string>& subset) {
  verb.add_option("--subset", subset, "Count only these landmarks")
      ->type_name("NAME,NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
}

void add_detection_options(CLI::App& verb, DetectionOptions& options) {
  add_choice(verb, "--quality", options.quality,
             "best: with the slower refinements; interactive: for a viewport", "best|interactive",
             {{"best", FOCAL_QUALITY_BEST}, {"interactive", FOCAL_QUALITY_INTERACTIVE}});
  add_choice(verb, "--orientation", options.orientation,
             "Models of rigs: upright: stands and faces like the training characters, mostly; any: any "
             "heading and up axis, slower",
             "upright|any", {{"upright", FOCAL_ORIENTATION_UPRIGHT}, {"any", FOCAL_ORIENTATION_ANY}});
}

focal_detect_params detect_params_of(const DetectionOptions& options, const CommonOptions& common) {
  auto params = initialised(focal_detect_params_init);
  params.quality = options.quality;
  params.orientation = options.orientation;
  params.seed = common.seed.value_or(params.seed);
  return params;
}

}  // namespace focal_cli
