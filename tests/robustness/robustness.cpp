// Landmarks on spoiled meshes: trains on clean shapes, spoils the judged ones from a seed, prints a table.
//   focal_robustness [--limit MESHES] [--seed N] [--json FILE] [--split test|validation] [--cases A,B] [--model FILE]
// FOCAL_EVALUATION_DATA: the folder of the evaluation sets; without it sample humanoids are made.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "base/atomic_file.h"
#include "base/stopwatch.h"
#include "judge.h"
#include "landmarks/train.h"
#include "model/model_file.h"
#include "regions.h"

namespace {

using namespace focal;
using namespace focal_robustness;

using Options = std::map<std::string, std::string>;

Options options_of(int count, char** arguments) {
  Options options{{"--limit", "0"},    {"--seed", "1"}, {"--json", ""},
                  {"--split", "test"}, {"--cases", ""}, {"--model", ""}};
  for (int i = 1; i < count; ++i) {
    const std::string name = arguments[i];
    if (!options.contains(name) || i + 1 == count) {
      std::cerr << "unknown option, or one without a value: " << name << '\n';
      std::exit(2);
    }
    options[name] = arguments[++i];
  }
  return options;
}

// From the file where there is one: training takes most of the time of a short run.
std::shared_ptr<const LandmarkModel> model_for(const Shapes& shapes, const std::string& file) {
  if (!file.empty() && std::filesystem::exists(file))
    return std::make_shared<const LandmarkModel>(parse_model(read_file(file)));
  TrainingSet set;
  set.landmark_names = shapes.landmark_names;
  for (const Shape& shape : shapes.training) set.shapes.push_back(prepared(shape));
  auto model = std::make_shared<const LandmarkModel>(train(set, TrainParams{}, {}));
  if (!file.empty()) write_file_atomically(file, serialise(*model));
  return model;
}

bool is_wanted(const std::string& list, const std::string& name) {
  if (list.empty() || name == "clean") return true;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');)
    if (name.find(word) != std::string::npos) return true;
  return false;
}

}  // namespace

int main(int count, char** arguments) {
  const Options options = options_of(count, arguments);
  const Split split = options.at("--split") == "validation" ? Split::validation : Split::test;
  const Shapes shapes = load_shapes(split, std::stoi(options.at("--limit")));
  Stopwatch watch;
  const auto model = model_for(shapes, options.at("--model"));
  std::fprintf(stderr, "%s: model of %zu shapes in %.0f s; %zu shapes are judged\n", shapes.set.c_str(),
               shapes.training.size(), watch.lap(), shapes.judged.size());
  std::vector<CaseResult> results;
  CleanAnswers clean;
  for (const Case& which : all_cases(shapes)) {
    if (!is_wanted(options.at("--cases"), which.name)) continue;
    results.push_back(run_case(which, shapes, model, std::stoull(options.at("--seed")), clean));
    std::fprintf(stderr, "%s: %.2f edges, %.1f s\n", which.name.c_str(), results.back().mean(), watch.lap());
  }
  print_table(results);
  const auto regions = is_wanted(options.at("--cases"), "regions") ? measure_regions(shapes, clean)
                                                                   : std::vector<RegionResult>{};
  if (!regions.empty()) print_regions(regions);
  if (!options.at("--json").empty()) {
    const nlohmann::json report{{"set", shapes.set},
                                {"split", options.at("--split")},
                                {"seed", std::stoull(options.at("--seed"))},
                                {"meshes", shapes.judged.size()},
                                {"cases", json_of(results)},
                                {"regions", json_of(regions)}};
    std::ofstream(options.at("--json")) << report.dump(1) << '\n';
  }
  return 0;
}
