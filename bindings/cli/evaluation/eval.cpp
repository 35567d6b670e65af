// focal eval: how well a model finds the marks of a set.
#include <iostream>
#include <optional>

#include "command_error.h"
#include "evaluation/outcomes.h"
#include "evaluation/report_page.h"
#include "files.h"
#include "models.h"
#include "output.h"
#include "parameters.h"
#include "progress.h"

namespace focal_cli {
namespace {

struct EvalOptions : CommonOptions, DetectionOptions {
  std::string model, set, split = "test", report;
  size_t limit = 0;
  std::vector<std::string> subset;
};

void check_some_known(const focal_model* model, const std::set<std::string>& counted,
                      const std::string& set) {
  for (const std::string& name : landmark_names_of(model)) {
    if (counted.contains(name)) return;
  }
  throw CommandError("the model knows none of the landmarks of set '" + set + "'",
                     "'focal info MODEL' lists its landmarks; use a set with the same names");
}

// One detection after the other; what the page shows is taken from each before it goes.
std::vector<MeshOutcome> outcomes_of(const focal_context* context, const focal_model* model,
                                     const SetFolder& set, const std::set<std::string>& counted,
                                     const EvalOptions& options, Progress& progress, ReportPage* page) {
  const std::vector<std::string> names = set.meshes(options.split, options.limit);
  auto params = detect_params_of(options, options);
  params.keep_votes = page != nullptr;
  std::vector<MeshOutcome> outcomes;
  for (size_t i = 0; i < names.size(); ++i) {
    focal_task* task = progress.begin(names[i], i, names.size());
    const MarkedMesh mesh = load_marked_mesh(context, set, names[i], options);
    const TimedDetection found = detect_on(model, mesh, params, task);
    outcomes.push_back(outcome_of(found, mesh, set, counted));
    if (page) page->add(mesh, found, outcomes.back());
  }
  return outcomes;
}

Json report_of(const EvalOptions& options, const SetFolder& set, const focal_model* model,
               const std::vector<MeshOutcome>& outcomes, const Summary& summary) {
  auto info = initialised(focal_model_info_init);
  auto params = initialised(focal_train_params_init);
  check(focal_model_get_info(model, &info));
  check(focal_model_get_train_params(model, &params));
  Json report = {{"set", set.name},
                 {"model", options.model},
                 {"preset", preset_name(info.preset)},
                 {"descriptor", focal_descriptor_name(params.descriptor)},
                 {"distance", focal_distance_name(params.distance)},
                 {"split", options.split},
                 {"quality", options.quality == FOCAL_QUALITY_BEST ? "best" : "interactive"}};
  report["meshes"] = Json::array();
  for (const MeshOutcome& mesh : outcomes) report["meshes"].push_back(mesh_json(mesh));
  report["landmarks"] = landmarks_json(outcomes);
  add_summary(report, summary);
  return report;
}

void evaluate(const EvalOptions& options) {
  if (!options.report.empty()) check_output_folder(options.report);
  const SetFolder set = read_set(options.set);
  const std::set<std::string> counted = counted_landmarks(set, options.subset);
  const size_t mesh_count = set.meshes(options.split, options.limit).size();
  const Context context = make_context(options);
  Progress progress(options.quiet);
  const auto model = load_model(context.get(), options.model);
  check_some_known(model.get(), counted, set.name);
  std::optional<ReportPage> page;
  if (!options.report.empty()) page.emplace(counted, mesh_count);
  const std::vector<MeshOutcome> outcomes =
      outcomes_of(context.get(), model.get(), set, counted, options, progress, page ? &*page : nullptr);
  progress.clear();
  const Summary summary = summarise(outcomes);
  const Json report = report_of(options, set, model.get(), outcomes, summary);
  if (page) write_file_atomically(options.report, page->html(report));
  if (options.json) print_json(report);
  if (!options.prints_text()) return;
  print_outcomes(std::cout, outcomes, summary);
  std::cout << "By preset " << report["preset"].get<std::string>() << ", descriptor "
            << report["descriptor"].get<std::string>() << ", distance "
            << report["distance"].get<std::string>() << ".\n";
  if (page) std::cout << "\nThe report is " << options.report << "; any browser opens it, offline too.\n";
}

}  // namespace

void add_eval(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("eval", "Measure a model on the marked meshes of a set");
  const auto options = std::make_shared<EvalOptions>();
  add_model_argument(*verb, options->model);
  verb->add_option("SET", options->set, "Folder with set.json, NAME.glb and NAME.landmarks.json")
      ->type_name("")
      ->required();
  add_split_options(*verb, options->split, options->limit, "Meshes to measure on");
  add_subset_option(*verb, options->subset);
  verb->add_option(
          "--report", options->report,
          "Report page to write: interactive meshes with marks and vote maps, tables, curves; opens offline")
      ->type_name("OUT.html");
  add_detection_options(*verb, *options);
  add_mesh_options(*verb, *options);
  add_common_options(*verb, *options);
  verb->callback([options] { evaluate(*options); });
}

}  // namespace focal_cli
