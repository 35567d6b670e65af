// focal_bench_stages: every stage on its own at about 12,500 vertices, with one thread and with two, next to its peer
// of the stock pipeline. Arguments are Google Benchmark's: --benchmark_filter=votes --benchmark_format=json.
#include <benchmark/benchmark.h>

#include "stages.h"
#include "stock.h"

namespace {

using namespace focal_bench;

const Values& values() {
  static const Values made(set_or_people("faust12k"));
  return made;
}

struct Peer {
  const char* name;
  std::function<void(const Values&, int threads)> run;
};

std::vector<Peer> stock_peers() {
  static const StockHeat heat(values().mesh->surface, values().operators);
  static const focal::RowMatrix distances = heat.distances(values().samples, 2);
  return {
      {"eigenpairs",
       [](const Values& v, int) { stock_eigenpairs(v.operators, v.model->params.eigenpair_count); }},
      {"heat_factors", [](const Values& v, int) { StockHeat(v.mesh->surface, v.operators); }},
      {"heat_distances", [](const Values& v, int threads) { heat.distances(v.samples, threads); }},
      {"votes", [](const Values& v, int threads) { stock_votes(v.tables, distances, threads); }},
      {"detect", [](const Values& v, int threads) { stock_detect(*v.model, v.subject.test, threads); }},
  };
}

void add(const std::string& name, const std::function<void(int threads)>& run, bool threaded) {
  auto* bench = benchmark::RegisterBenchmark(name.c_str(), [run](benchmark::State& state) {
    for (auto _ : state) run(static_cast<int>(state.range(0)));
  });
  bench->ArgName("threads")->Arg(1)->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::millisecond);
  if (threaded) bench->Arg(2);
}

// Refinement starts from inner values of detection, so detection itself tells how long it took.
void add_refine() {
  benchmark::RegisterBenchmark("focal/refine",
                               [](benchmark::State& state) {
                                 for (auto _ : state) {
                                   const auto detection = whole_detect(
                                       values().quick_model, values().subject.test,
                                       detect_variants()[0].params, static_cast<int>(state.range(0)));
                                   state.SetIterationTime(detection.seconds.refine);
                                 }
                               })
      ->ArgName("threads")
      ->Arg(1)
      ->Arg(2)
      ->UseManualTime()
      ->Iterations(5)
      ->Unit(benchmark::millisecond);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("subject", values().subject.name);
  const auto peers = stock_peers();
  for (const Stage& stage : focal_stages()) {
    add(
        "focal/" + stage.name, [stage](int threads) { stage.run(values(), threads_of(threads)); },
        stage.threaded);
    for (const Peer& peer : peers)
      if (peer.name == stage.name)
        add(
            "stock/" + stage.name, [peer](int threads) { peer.run(values(), threads); }, stage.threaded);
    if (stage.name == "constellation") add_refine();
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
