// focal_bench_compare: focal against the stock pipeline, both sides in turn in one run. Prints one table of medians for
// the docs, or with --json a list of rows.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "landmarks/train.h"
#include "stages.h"
#include "stock.h"
#include "timing.h"

namespace {

using namespace focal_bench;

struct Options {
  int runs = 5, train_runs = 0, threads = 2;
  bool json = false;
};

struct Row {
  std::string what;
  Seconds focal, other;            // other 0: nothing to compare with
  const char* other_is = "stock";  // or what focal's time is held against
  std::string note;
};

void compare_detect(const Values& v, const Options& options, std::vector<Row>& rows) {
  const auto variants = detect_variants();
  std::vector<std::function<void()>> works = {
      [&] { stock_detect(*v.model, v.subject.test, options.threads); }};
  for (const auto& variant : variants)
    works.push_back([&] {
      whole_detect(variant.full_resolution ? v.model : v.quick_model, v.subject.test, variant.params,
                   options.threads);
    });
  const auto seconds = medians_in_turn(options.runs, works);
  for (size_t i = 0; i < variants.size(); ++i)
    rows.push_back({"detect, " + v.subject.name + ", " + variants[i].name, seconds[i + 1], seconds[0],
                    "stock",
                    seconds[0].wall > 6 ? "the stock pipeline took more than 6 s: not a fair peer" : ""});
}

void compare_threads(const Values& v, const Options& options, std::vector<Row>& rows) {
  const auto params = detect_variants()[0].params;
  const auto seconds =
      medians_in_turn(options.runs, {[&] { whole_detect(v.quick_model, v.subject.test, params, 2); },
                                     [&] { whole_detect(v.quick_model, v.subject.test, params, 1); }});
  rows.push_back({"detect on two threads, interactive", seconds[0], seconds[1], "one thread", ""});
}

void time_second_model(const Values& v, const Options& options, std::vector<Row>& rows) {
  const auto params = detect_variants()[0].params;
  const auto analysis = analysed(v, params, options.threads);
  const auto seconds =
      medians_in_turn(options.runs, {[&] { second_detect(v, analysis, params, options.threads); }});
  rows.push_back({"second model on an analysed mesh", seconds[0], {}, "", ""});
}

void compare_eigenpairs(const Values& v, const Options& options, std::vector<Row>& rows) {
  focal::Eigenbasis ours, theirs;
  const int32_t count = v.model->params.eigenpair_count;
  const auto seconds = medians_in_turn(
      options.runs, {[&] { ours = focal_eigenpairs(v.operators, count, threads_of(options.threads)); },
                     [&] { theirs = stock_eigenpairs(v.operators, count); }});
  double worst = 0;  // the first is 0, so it has no relative error
  for (int32_t i = 1; i < count; ++i)
    worst = std::max(worst, std::abs(ours.lambda[i] - theirs.lambda[i]) / theirs.lambda[i]);
  char note[80];
  std::snprintf(note, sizeof note, "eigenvalues differ by at most %.1e", worst);
  rows.push_back({std::to_string(count) + " eigenpairs", seconds[0], seconds[1], "Spectra", note});
}

void compare_distances(const Values& v, const Options& options, std::vector<Row>& rows) {
  const auto execution = threads_of(options.threads);
  const auto seconds = medians_in_turn(
      options.runs,
      {[&] { focal_distances(focal::HeatMethod(v.mesh->surface, v.operators), v.samples, execution); },
       [&] { StockHeat(v.mesh->surface, v.operators).distances(v.samples, options.threads); }});
  const std::vector<int32_t> few(v.samples.begin(), v.samples.begin() + 32);
  const auto ours = v.heat.distances(few, execution).cast<double>().eval();
  const auto theirs = StockHeat(v.mesh->surface, v.operators).distances(few, options.threads);
  char note[80];
  std::snprintf(note, sizeof note, "factors included; mean difference %.1e of the largest",
                (ours - theirs).cwiseAbs().mean() / theirs.maxCoeff());
  rows.push_back({"heat distances from " + std::to_string(v.samples.size()) + " vertices", seconds[0],
                  seconds[1], "per source", note});
}

void time_training(const Values& v, const Options& options, std::vector<Row>& rows) {
  const int runs = options.train_runs ? options.train_runs : options.runs;
  const auto seconds = medians_in_turn(
      runs, {[&] { focal::train(v.subject.training, v.quick_model->params, threads_of(options.threads)); }});
  rows.push_back(
      {"train, " + std::to_string(v.subject.training.shapes.size()) + " shapes like " + v.subject.name,
       seconds[0],
       {},
       "",
       ""});
}

double ratio(const Row& row) { return row.other.wall / row.focal.wall; }

void print_json(const std::vector<Row>& rows) {
  auto list = nlohmann::json::array();
  for (const Row& row : rows) {
    list.push_back({{"what", row.what},
                    {"focal_seconds", row.focal.wall},
                    {"focal_cpu_seconds", row.focal.cpu},
                    {"note", row.note}});
    if (row.other.wall == 0) continue;
    list.back().update({{"against", row.other_is},
                        {"against_seconds", row.other.wall},
                        {"against_cpu_seconds", row.other.cpu},
                        {"ratio", ratio(row)}});
  }
  std::printf("%s\n", list.dump(1).c_str());
}

void print_table(const std::vector<Row>& rows, const Options& options) {
  std::printf("Medians of %d runs, both sides in turn, %d threads. CPU: of all threads together.\n\n",
              options.runs, options.threads);
  std::printf("| what | focal, s | CPU, s | against | s | CPU, s | ratio | note |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    std::printf("| %s | %.3f | %.3f | %s |", row.what.c_str(), row.focal.wall, row.focal.cpu, row.other_is);
    if (row.other.wall > 0)
      std::printf(" %.3f | %.3f | %.1f |", row.other.wall, row.other.cpu, ratio(row));
    else
      std::printf(" | | |");
    std::printf(" %s |\n", row.note.c_str());
  }
}

}  // namespace

int main(int argc, char** argv) try {
  Options options;
  CLI::App app("focal against the stock pipeline");
  app.add_option("--runs", options.runs, "of each side")->check(CLI::PositiveNumber);
  app.add_option("--train-runs", options.train_runs, "of training; 0: as --runs");
  app.add_option("--threads", options.threads, "of both sides")->check(CLI::PositiveNumber);
  app.add_flag("--json", options.json, "print rows as JSON");
  CLI11_PARSE(app, argc, argv);

  std::vector<Row> rows;
  {
    const Values values(set_or_people("faust12k"));
    compare_detect(values, options, rows);
    compare_threads(values, options, rows);
    time_second_model(values, options, rows);
    compare_eigenpairs(values, options, rows);
    compare_distances(values, options, rows);
    time_training(values, options, rows);
  }
  if (auto many_landmarks = real_set("scape")) {
    const Values values(*std::move(many_landmarks));
    compare_detect(values, options, rows);
    time_training(values, options, rows);
  }
  options.json ? print_json(rows) : print_table(rows, options);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "focal_bench_compare: %s\n", error.what());
  return 1;
}
