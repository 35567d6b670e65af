// focal_bench_count STAGE...: runs stages once, single-threaded, on a small fixed character, and asks callgrind for one
// dump a stage. Run by instructions.sh; on its own it does nothing to see.
#include <valgrind/callgrind.h>

#include <algorithm>
#include <cstdio>

#include "landmarks/train.h"
#include "stages.h"

namespace {

using namespace focal_bench;

constexpr int32_t vertex_count = 1500;
constexpr int shapes = 2;
constexpr int32_t eigenpairs = 100;  // half of the usual: they take most of the time under valgrind

Values small_values() {
  Subject people = sample_people(shapes, vertex_count);
  auto params = focal::TrainParams::from_preset(focal::Preset::default_preset);
  params.eigenpair_count = eigenpairs;
  params.bulge = false;  // the stages look at signatures alone
  auto model = std::make_shared<focal::LandmarkModel>(focal::train(people.training, params, threads_of(1)));
  return Values(std::move(people), std::move(model));
}

// Whole solves are counted; a block alone would say the same again. Training takes as long as all other stages together,
// most of it in them: counted only when asked for.
bool is_counted(const std::string& stage, const std::vector<std::string>& wanted) {
  if (stage.starts_with("solve_32") || (stage == "train" && wanted.empty())) return false;
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), stage) != wanted.end();
}

}  // namespace

int main(int argc, char** argv) try {
  const std::vector<std::string> wanted(argv + 1, argv + argc);
  const Values values = small_values();
  for (const Stage& stage : focal_stages()) {
    if (!is_counted(stage.name, wanted)) continue;
    CALLGRIND_START_INSTRUMENTATION;
    CALLGRIND_ZERO_STATS;
    stage.run(values, threads_of(1));
    CALLGRIND_DUMP_STATS_AT(stage.name.c_str());
    CALLGRIND_STOP_INSTRUMENTATION;
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "focal_bench_count: %s\n", error.what());
  return 1;
}
