// focal train: from a set to a model file.
#include <chrono>
#include <iostream>

#include "command_error.h"
#include "evaluation/outcomes.h"
#include "files.h"
#include "marked_mesh.h"
#include "output.h"
#include "parameters.h"
#include "progress.h"
#include "text_table.h"

namespace focal_cli {
namespace {

struct TrainingOptions : CommonOptions, TrainOptions {
  std::string set, output, skeleton_template, split = "train";
  std::vector<std::string> rigs;
  size_t limit = 0;
};

std::vector<MarkedMesh> load_all(const focal_context* context, const SetFolder& set,
                                 const std::vector<std::string>& names, const MeshOptions& how,
                                 Progress& progress) {
  std::vector<MarkedMesh> meshes;
  for (const std::string& name : names) {
    progress.begin("loading " + name);
    meshes.push_back(load_marked_mesh(context, set, name, how));
  }
  return meshes;
}

Json report_of(const TrainingOptions& options, const SetFolder& set, const std::vector<std::string>& names,
               const Model& model, double seconds, const focal_context* context) {
  auto info = initialised(focal_model_info_init);
  check(focal_model_get_info(model.get(), &info));
  return {{"model", options.output},
          {"set", set.name},
          {"preset", preset_name(info.preset)},
          {"meshes", names},
          {"landmarks", set.landmark_names},
          {"joints", joint_names_of(model.get())},
          {"samples", info.sample_count},
          {"tree_nodes", info.tree_node_count},
          {"file_bytes", info.file_bytes},
          {"seconds", seconds},
          {"peak_memory_bytes", focal_peak_memory_bytes()},
          {"backend", backend_name(focal_context_backend(context))}};
}

// What the library finds odd about the characters, in sentences; throws where they cannot teach.
Json odd_rigs(focal_training_set* training_set) {
  check(focal_training_set_check(training_set));
  Json warnings = Json::array();
  for (uint32_t i = 0; i < focal_training_set_warning_count(training_set); ++i)
    warnings.push_back(focal_training_set_warning(training_set, i));
  return warnings;
}

// Landmarks follow from the skeletons; nothing has to be marked.
void train_on_rigs(const TrainingOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check_output_folder(options.output);
  const Context context = make_context(options);
  Progress progress(options.quiet);
  const auto training_set = owned<TrainingSet>(focal_training_set_create, context.get(),
                                               static_cast<const char* const*>(nullptr), uint64_t{0});
  for (const std::string& path : options.rigs) {
    progress.begin("loading " + path);
    const Mesh mesh = load_mesh(context.get(), path, options);
    check(focal_training_set_add_rig(training_set.get(), mesh.get()), path + ": ");
  }
  progress.clear();
  const Json warnings = odd_rigs(training_set.get());  // before the long work
  if (options.prints_text())
    for (const Json& warning : warnings) std::cerr << "warning: " << warning.get<std::string>() << "\n";
  const focal_train_params params = train_params_of(options, options);
  const auto model = owned<Model>(focal_model_train, training_set.get(), &params, progress.begin("training"));
  check(focal_model_save(model.get(), options.output.c_str()));
  progress.clear();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  auto info = initialised(focal_model_info_init);
  check(focal_model_get_info(model.get(), &info));
  const std::vector<std::string> joints = joint_names_of(model.get());
  if (options.json)
    print_json({{"model", options.output},
                {"rigs", options.rigs},
                {"warnings", warnings},
                {"joints", joints},
                {"landmarks", landmark_names_of(model.get())},
                {"shapes", info.shape_count},
                {"file_bytes", info.file_bytes},
                {"seconds", seconds},
                {"peak_memory_bytes", focal_peak_memory_bytes()},
                {"backend", backend_name(focal_context_backend(context.get()))}});
  if (options.prints_text())
    std::cout << "Learned " << joints.size() << " joints and " << info.landmark_count << " landmarks from "
              << options.rigs.size() << " rigged character" << (options.rigs.size() == 1 ? "" : "s") << " in "
              << fixed_text(seconds, 1) << " s.\n"
              << options.output << ": " << bytes_text(static_cast<double>(info.file_bytes)) << "\n";
}

void train(const TrainingOptions& options) {
  if (options.rigs.empty() == options.set.empty())
    throw CommandError("give either a SET or --rigs", "'focal train --help' shows both");
  if (!options.rigs.empty()) return train_on_rigs(options);
  const auto start = std::chrono::steady_clock::now();
  const SetFolder set = read_set(options.set);
  const std::vector<std::string> names = set.meshes(options.split, options.limit);
  check_output_folder(options.output);
  const Context context = make_context(options);
  Progress progress(options.quiet);
  const std::vector<MarkedMesh> meshes = load_all(context.get(), set, names, options, progress);
  std::vector<const MarkedMesh*> pointers;
  for (const MarkedMesh& mesh : meshes) pointers.push_back(&mesh);
  const TrainingSet training_set = training_set_of(context.get(), set, pointers);
  if (!options.skeleton_template.empty()) {
    const std::string text = read_text_file(options.skeleton_template);
    check(focal_training_set_set_skeleton(training_set.get(), text.c_str()),
          options.skeleton_template + ": ");
  }
  const focal_train_params params = train_params_of(options, options);
  const auto model = owned<Model>(focal_model_train, training_set.get(), &params, progress.begin("training"));
  check(focal_model_save(model.get(), options.output.c_str()));
  progress.clear();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Json report = report_of(options, set, names, model, seconds, context.get());
  if (options.json) print_json(report);
  if (options.prints_text()) {
    std::cout << "Learned " << set.landmark_names.size() << " landmarks from " << names.size()
              << " meshes of " << set.name << " in " << fixed_text(seconds, 1) << " s.\n";
    if (const size_t joints = report["joints"].size())
      std::cout << "It carries a skeleton of " << joints << " joints for 'focal rig'.\n";
    std::cout << options.output << ": " << bytes_text(report["file_bytes"].get<double>()) << "\n";
  }
}

}  // namespace

void add_train(CLI::App& app) {
  CLI::App* verb = app.add_subcommand(
      "train", "Learn landmarks from a set of marked meshes, or a skeleton from rigged characters");
  const auto options = std::make_shared<TrainingOptions>();
  verb->add_option("SET", options->set, "Folder with set.json, NAME.glb and NAME.landmarks.json")
      ->type_name("");
  CLI::Option* rigs = verb->add_option("--rigs", options->rigs,
                                       "Instead of SET: rigged characters with one skeleton, .glb; one is "
                                       "enough. Learns their skeleton and "
                                       "skin weights for 'focal rig', and landmarks derived from them")
                          ->type_name("A.glb B.glb ...");
  verb->add_option("-o,--output", options->output, "Model file to write")->type_name("MODEL")->required();
  add_split_options(*verb, options->split, options->limit, "Meshes to learn from");
  verb->add_option("--template", options->skeleton_template,
                   "A skeleton over the set's landmarks, stored in the model for 'focal rig'; docs/rigs.md "
                   "describes it")
      ->type_name("FILE.json");
  for (const char* of_sets : {"--split", "--limit", "--template"})
    if (CLI::Option* option = verb->get_option_no_throw(of_sets)) option->excludes(rigs);
  add_train_options(*verb, *options);
  add_mesh_options(*verb, *options);
  add_common_options(*verb, *options);
  verb->callback([options] { train(*options); });
}

}  // namespace focal_cli
