// focal_bench_count STAGE...: runs stages once, single-threaded, on a small fixed character, and asks callgrind for one
// dump a stage. Run by instructions.sh; on its own it does nothing to see.
#include <valgrind/callgrind.h>

#include <algorithm>
#include <cstdio>

#include "stages.h"

namespace {

using namespace focal_bench;

constexpr int32_t vertex_count = 1500;
constexpr int shapes = 3;

// Training as a whole would count every stage again, ten times over.
std::vector<Stage> counted_stages() {
  auto stages = focal_stages();
  std::erase_if(stages, [](const Stage& stage) { return stage.name.starts_with("solve_32"); });
  return stages;
}

}  // namespace

int main(int argc, char** argv) try {
  const std::vector<std::string> wanted(argv + 1, argv + argc);
  const Values values(sample_people(shapes, vertex_count));
  for (const Stage& stage : counted_stages()) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), stage.name) == wanted.end()) continue;
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
