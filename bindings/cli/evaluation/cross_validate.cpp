// focal cross-validate: train and evaluate in turn, no mesh in both.
#include <algorithm>
#include <iostream>

#include "command_error.h"
#include "evaluation/folds.h"
#include "evaluation/outcomes.h"
#include "output.h"
#include "parameters.h"
#include "progress.h"

namespace focal_cli {
namespace {

constexpr size_t max_folds = 10;  // leave-one-out up to ten meshes
constexpr size_t min_meshes = 3;  // one left out leaves two, the fewest that can be learned from

struct CrossValidationOptions : CommonOptions, DetectionOptions, TrainOptions {
  std::string set, split = "train";
  size_t folds = 0, limit = 0;
  std::vector<std::string> subset;
};

size_t chosen_folds(const CrossValidationOptions& options, size_t meshes) {
  if (meshes < min_meshes) {
    throw CommandError("cross-validation needs at least 3 meshes, but there are " + std::to_string(meshes),
                       "mark more meshes, or choose another --split or --limit");
  }
  if (options.folds > meshes) {
    throw CommandError(
        std::to_string(options.folds) + " folds are more than the " + std::to_string(meshes) + " meshes",
        "use --folds " + std::to_string(meshes) + " or fewer");
  }
  return options.folds > 0 ? options.folds : std::min(meshes, max_folds);
}

// One fold: a model from the meshes of the other folds, measured on its own. A fold is one training and as
// many detections as it has meshes; progress counts each as a step.
class CrossValidation {
 public:
  CrossValidation(const CrossValidationOptions& options, const SetFolder& set,
                  const std::vector<std::string>& names, const focal_context* context, Progress& progress)
      : options_(options),
        set_(set),
        counted_(counted_landmarks(set, options.subset)),
        context_(context),
        progress_(progress),
        fold_count_(chosen_folds(options, names.size())),
        folds_(folds_of(names.size(), fold_count_)) {
    for (const std::string& name : names) {
      progress.begin("loading " + name, 0, steps());
      meshes_.push_back(load_marked_mesh(context, set, name, options));
    }
  }

  std::vector<MeshOutcome> run() {
    std::vector<MeshOutcome> outcomes;
    for (size_t fold = 0; fold < fold_count_; ++fold) {
      const Model model = train_without(fold);
      auto params = detect_params_of(options_, options_);
      params.keep_votes = 0;
      for (size_t i = 0; i < folds_.size(); ++i) {
        if (folds_[i] != fold) continue;
        focal_task* task =
            progress_.begin("fold " + std::to_string(fold + 1) + ", " + meshes_[i].name, step_++, steps());
        outcomes.push_back(evaluate_mesh(model.get(), meshes_[i], set_, counted_, params, task));
      }
    }
    return outcomes;
  }

  size_t fold_count() const { return fold_count_; }
  size_t fold_of(size_t mesh) const { return folds_[mesh]; }

 private:
  Model train_without(size_t fold) {
    std::vector<const MarkedMesh*> others;
    for (size_t i = 0; i < folds_.size(); ++i) {
      if (folds_[i] != fold) others.push_back(&meshes_[i]);
    }
    focal_task* task = progress_.begin("fold " + std::to_string(fold + 1) + ", training", step_++, steps());
    const TrainingSet training_set = training_set_of(context_, set_, others);
    const focal_train_params params = train_params_of(options_, options_);
    return owned<Model>(focal_model_train, training_set.get(), &params, task);
  }
  size_t steps() const { return folds_.size() + fold_count_; }

  const CrossValidationOptions& options_;
  const SetFolder& set_;
  const std::set<std::string> counted_;
  const focal_context* context_;
  Progress& progress_;
  const size_t fold_count_;
  const std::vector<size_t> folds_;
  std::vector<MarkedMesh> meshes_;
  size_t step_ = 0;
};

void cross_validate(const CrossValidationOptions& options) {
  const SetFolder set = read_set(options.set);
  const std::vector<std::string> names = set.meshes(options.split, options.limit);
  const Context context = make_context(options);
  Progress progress(options.quiet);
  CrossValidation validation(options, set, names, context.get(), progress);
  const std::vector<MeshOutcome> outcomes = validation.run();
  progress.clear();
  const Summary summary = summarise(outcomes);
  Json report = {{"set", set.name},
                 {"preset", preset_name(options.preset)},
                 {"folds", validation.fold_count()},
                 {"descriptor", focal_descriptor_name(options.descriptor)},
                 {"distance", focal_distance_name(options.distance)}};
  report["meshes"] = Json::array();
  for (size_t i = 0; i < outcomes.size();
       ++i) {  // folds are neighbours, so outcomes come in the meshes' order
    report["meshes"].push_back(mesh_json(outcomes[i]));
    report["meshes"].back()["fold"] = validation.fold_of(i);
  }
  report["landmarks"] = landmarks_json(outcomes);
  add_summary(report, summary);
  if (options.json) print_json(report);
  if (!options.prints_text()) return;
  print_outcomes(std::cout, outcomes, summary);
}

}  // namespace

void add_cross_validate(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("cross-validate", "Train on one part of a set and evaluate on the rest, in turn");
  const auto options = std::make_shared<CrossValidationOptions>();
  verb->add_option("SET", options->set, "Folder with set.json, NAME.glb and NAME.landmarks.json")
      ->type_name("")
      ->required();
  verb->add_option("--folds", options->folds,
                   "Number of parts to leave out in turn; default: one mesh each, up to 10 parts")
      ->type_name("K")
      ->check(CLI::Range(2, 1000000).description(""));
  add_split_options(*verb, options->split, options->limit, "Meshes to use");
  add_subset_option(*verb, options->subset);
  add_train_options(*verb, *options);
  add_detection_options(*verb, *options);
  add_mesh_options(*verb, *options);
  add_common_options(*verb, *options);
  verb->callback([options] { cross_validate(*options); });
}

}  // namespace focal_cli
