// focal train: from a set to a model file.
#include <chrono>
#include <iostream>

#include "marked_mesh.h"
#include "output.h"
#include "parameters.h"
#include "progress.h"
#include "text_table.h"

namespace focal_cli {
namespace {

struct Options : CommonOptions, TrainOptions {
  std::string set, output, split = "train";
  size_t limit = 0;
};

std::vector<MarkedMesh> load_all(const focal_context* context, const SetFolder& set,
                                 const std::vector<std::string>& names, Progress& progress) {
  std::vector<MarkedMesh> meshes;
  for (const std::string& name : names) {
    progress.begin("loading " + name);
    meshes.push_back(load_marked_mesh(context, set, name));
  }
  return meshes;
}

Json report_of(const Options& options, const SetFolder& set, const std::vector<std::string>& names,
               const Model& model, double seconds, const focal_context* context) {
  auto info = initialised(focal_model_info_init);
  check(focal_model_get_info(model.get(), &info));
  return {{"model", options.output},
          {"set", set.name},
          {"preset", preset_name(info.preset)},
          {"meshes", names},
          {"landmarks", set.landmark_names},
          {"samples", info.sample_count},
          {"tree_nodes", info.tree_node_count},
          {"file_bytes", info.file_bytes},
          {"seconds", seconds},
          {"peak_memory_bytes", focal_peak_memory_bytes()},
          {"backend", backend_name(focal_context_backend(context))}};
}

void train(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  const SetFolder set = read_set(options.set);
  const std::vector<std::string> names = set.meshes(options.split, options.limit);
  check_output_folder(options.output);
  const Context context = make_context(options);
  Progress progress(options.quiet);
  const std::vector<MarkedMesh> meshes = load_all(context.get(), set, names, progress);
  std::vector<const MarkedMesh*> pointers;
  for (const MarkedMesh& mesh : meshes) pointers.push_back(&mesh);
  const TrainingSet training_set = training_set_of(context.get(), set, pointers);
  const focal_train_params params = train_params_of(options, options);
  const auto model = owned<Model>(focal_model_train, training_set.get(), &params, progress.begin("training"));
  check(focal_model_save(model.get(), options.output.c_str()));
  progress.clear();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Json report = report_of(options, set, names, model, seconds, context.get());
  if (options.json) print_json(report);
  if (options.prints_text()) {
    std::cout << "Learned " << set.landmark_names.size() << " landmarks from " << names.size()
              << " meshes of " << set.name << " in " << fixed_text(seconds, 1) << " s.\n"
              << options.output << ": " << bytes_text(report["file_bytes"].get<double>()) << "\n";
  }
}

}  // namespace

void add_train(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("train", "Learn landmarks from a set of marked meshes");
  const auto options = std::make_shared<Options>();
  verb->add_option("SET", options->set, "Folder with set.json, NAME.glb and NAME.landmarks.json")
      ->type_name("")
      ->required();
  verb->add_option("-o,--output", options->output, "Model file to write")->type_name("MODEL")->required();
  verb->add_option("--split", options->split, "Meshes to learn from: train, test, extra or all")
      ->type_name("NAME")
      ->capture_default_str();
  verb->add_option("--limit", options->limit, "Only the first N meshes")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000000).description(""));
  add_train_options(*verb, *options);
  add_common_options(*verb, *options);
  verb->callback([options] { train(*options); });
}

}  // namespace focal_cli
