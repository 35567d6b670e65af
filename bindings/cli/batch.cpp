// focal batch: runs a model on every mesh in a folder. Existing results are kept, and a mesh that fails does not stop the others.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "command_error.h"
#include "files.h"
#include "marked_mesh.h"
#include "models.h"
#include "output.h"
#include "parameters.h"
#include "paths.h"
#include "progress.h"
#include "text_table.h"
#include "verdict_text.h"

namespace focal_cli {
namespace {

namespace fs = std::filesystem;

struct BatchOptions : CommonOptions, DetectionOptions {
  std::string model, input, output, shard;
  bool rig = false, keep_failed = false;
};

// "2/3": every third file, from the second on.
std::pair<size_t, size_t> shard_of(const std::string& text) {
  if (text.empty()) return {0, 1};
  unsigned long index = 0, count = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lu/%lu%c", &index, &count, &rest) != 2 || index < 1 || index > count)
    throw CommandError("'" + text + "' is no shard", "write 1/3, 2/3 and 3/3 to divide the work among three");
  return {index - 1, count};
}

struct Found {
  std::vector<fs::path> meshes, others;  // in order
};

Found files_in(const std::string& folder, const std::string& shard) {
  std::error_code error;
  std::vector<fs::path> files;
  Found found;
  for (const auto& entry : fs::directory_iterator(path_of(folder), error))
    if (entry.is_regular_file())
      (is_gltf(text_of(entry.path())) ? files : found.others).push_back(entry.path());
  if (error) throw CommandError("cannot read the folder " + folder, error.message());
  if (files.empty()) throw CommandError("no .glb, .gltf or .vrm in " + folder, "pass a folder with meshes");
  std::sort(files.begin(), files.end());
  std::sort(found.others.begin(), found.others.end());
  const auto [index, count] = shard_of(shard);
  for (size_t i = index; i < files.size(); i += count) found.meshes.push_back(files[i]);
  return found;
}

// The mesh's own file with landmarks, and with a skeleton if asked for.
Json process(const Context& context, const focal_model* model, const fs::path& file, const fs::path& target,
             const BatchOptions& options, focal_task* task) {
  const Mesh mesh = load_mesh(context.get(), text_of(file), options);
  auto params = detect_params_of(options, options);
  params.keep_votes = 0;
  const auto detection = owned<Detection>(focal_model_detect, model, mesh.get(), &params, task);
  Json entry = {{"status", "done"}};
  if (options.rig) {
    const auto skeleton = owned<Skeleton>(focal_skeleton_create, detection.get(),
                                          static_cast<const focal_skeleton_params*>(nullptr), task);
    const RigVerdict verdict = verdict_of(skeleton.get(), detection.get());
    add_verdict(entry, verdict);
    if (verdict.failed())
      entry["status"] = "failed", entry["error"] = "the verdict on its rig",
      entry["hint"] = verdict_hint(verdict);
    if (!verdict.failed() || options.keep_failed)
      check(focal_skeleton_write_gltf(skeleton.get(), text_of(target).c_str()));
  } else {
    check(focal_detection_write_gltf(detection.get(), text_of(target).c_str()));
  }
  auto info = initialised(focal_detection_info_init);
  check(focal_detection_get_info(detection.get(), &info));
  int found = 0;
  for (uint32_t i = 0; i < info.landmark_count; ++i) {
    auto landmark = initialised(focal_landmark_init);
    check(focal_detection_get_landmark(detection.get(), i, &landmark));
    found += landmark.status == FOCAL_LANDMARK_FOUND;
  }
  entry.update({{"found", found}, {"landmarks", info.landmark_count}, {"category_fit", info.category_fit}});
  return entry;
}

// How many rigs of each verdict this run made.
Json verdict_counts(const Json& list) {
  Json counts = {{"good", 0}, {"check", 0}, {"failed", 0}};
  for (const Json& entry : list)
    if (entry.contains("verdict")) {
      Json& count = counts[entry["verdict"].get<std::string>()];
      count = count.get<int>() + 1;
    }
  return counts;
}

void print_report(const BatchOptions& options, const Json& list, const std::vector<fs::path>& others,
                  size_t kept, size_t failed) {
  const Json verdicts = verdict_counts(list);
  const size_t done = list.size() - failed - kept;
  if (options.json) {
    Json skipped = Json::array();
    for (const fs::path& other : others) skipped.push_back(text_of(other));
    Json report = {
        {"meshes", list}, {"done", done}, {"kept", kept}, {"failed", failed}, {"skipped", skipped}};
    if (options.rig) report["verdicts"] = verdicts;
    print_json(report);
  }
  if (!options.prints_text()) return;
  for (const Json& entry : list)
    std::cout << entry["mesh"].get<std::string>() << ": " << entry["status"].get<std::string>()
              << (entry.contains("error") ? ", " + entry["error"].get<std::string>() : "")
              << (entry.contains("verdict") ? ", " + entry["verdict"].get<std::string>() + ", quality " +
                                                  percent_text(entry["quality"].get<double>(), 0)
                                            : "")
              << "\n";
  std::cout << done << " done, " << kept << " there already, " << failed << " failed\n";
  if (!others.empty())
    std::cout << others.size() << " other file" << (others.size() == 1 ? "" : "s")
              << " skipped, not .glb, .gltf or .vrm: " << text_of(others[0].filename())
              << (others.size() > 1 ? ", ..." : "") << "\n";
  if (options.rig)
    std::cout << "rigs: " << verdicts["good"] << " good, " << verdicts["check"] << " to check, "
              << verdicts["failed"] << " failed\n";
}

void batch(const BatchOptions& options) {
  const auto [files, others] = files_in(options.input, options.shard);
  std::error_code error;
  fs::create_directories(path_of(options.output), error);
  if (error) throw CommandError("cannot make the folder " + options.output, error.message());
  const Context context = make_context(options);
  Progress progress(options.quiet);
  const auto model = load_model(context.get(), options.model);
  Json list = Json::array();
  size_t failed = 0, kept = 0;
  for (size_t i = 0; i < files.size(); ++i) {
    const fs::path target = path_of(options.output) / files[i].filename();
    focal_task* task = progress.begin(text_of(files[i].filename()), i, files.size());
    Json entry = {{"mesh", text_of(files[i])}, {"output", text_of(target)}};
    if (fs::exists(target)) {
      entry["status"] = "there already", ++kept;
    } else {
      try {
        entry.update(process(context, model.get(), files[i], target, options, task));
        failed += entry["status"] == "failed";
      } catch (const CommandError& problem) {
        if (focal_task_is_cancelled(task)) throw CommandError("cancelled", "run it again to resume");
        entry["status"] = "failed", entry["error"] = problem.what(), entry["hint"] = problem.hint, ++failed;
      }
    }
    list.push_back(std::move(entry));
  }
  progress.clear();
  print_report(options, list, others, kept, failed);
  if (failed > 0)
    throw CommandError(std::to_string(failed) + " of " + std::to_string(files.size()) + " meshes failed",
                       "the others are done; fix the failed ones and run it again");
}

}  // namespace

void add_batch(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("batch", "Run a model on every mesh in a folder; resumes interrupted runs");
  const auto options = std::make_shared<BatchOptions>();
  add_model_argument(*verb, options->model);
  verb->add_option("FOLDER", options->input, "Folder with .glb and .gltf files")->type_name("")->required();
  verb->add_option("-o,--output", options->output,
                   "Folder for the results, each named like its mesh; existing results are kept")
      ->type_name("FOLDER")
      ->required();
  CLI::Option* rig = verb->add_flag(
      "--rig", options->rig, "Also add a skeleton and skin weights; needs a model of rigged characters");
  verb->add_flag("--keep-failed", options->keep_failed,
                 "With --rig: write a file even if the verdict is 'failed'")
      ->needs(rig);
  verb->add_option("--shard", options->shard, "Process only part I of N of the files, to share the work")
      ->type_name("I/N");
  add_detection_options(*verb, *options);
  add_mesh_options(*verb, *options);
  add_common_options(*verb, *options);
  verb->callback([options] { batch(*options); });
}

}  // namespace focal_cli
