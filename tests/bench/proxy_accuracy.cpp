// focal_bench_proxy: how much accuracy the proxy costs. Every evaluation set is learned and tested on proxies and at full
// resolution; the difference of each test mesh, averaged over the seeds, is pooled over all sets and resampled.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <numeric>

#include "base/random.h"
#include "landmarks/detect.h"
#include "landmarks/train.h"
#include "mesh/prepare.h"
#include "placing.h"
#include "subject.h"

namespace {

using namespace focal;

constexpr Quality qualities[] = {Quality::best, Quality::interactive};
constexpr int32_t proxies[] = {3500, 0};
struct Errors {
  double sum[2][2] = {};  // [quality][proxy]: mean error in edges, summed over the seeds
  int turned[2][2] = {};  // seeds whose mean error is that of a whole shape turned round
};
using MeshErrors = std::map<std::string, Errors>;  // by test mesh

double mean_error(const MarkedShape& shape, const std::vector<DetectedLandmark>& found) {
  const TriangleMesh& surface = shape.mesh->surface;
  double sum = 0, count = 0;
  for (size_t l = 0; l < found.size(); ++l)
    if (shape.marks[l]) {
      const SurfacePoint at = to_surface(*shape.mesh, found[l].source_point);
      sum += (position_of(surface, at) - position_of(surface, *shape.marks[l])).norm(), ++count;
    }
  return sum / count / mean_edge_length(surface);
}

void add_errors(const focal_bench::MarkedSet& set, uint64_t seed, int threads, MeshErrors& errors) {
  const Execution execution = focal_bench::threads_of(threads);
  for (int p = 0; p < 2; ++p) {
    TrainParams params = TrainParams::from_preset(Preset::default_preset);
    params.seed = seed, params.proxy_vertices = proxies[p], params.learns_confidence = false;
    const auto model = std::make_shared<const LandmarkModel>(train(set.training, params, execution));
    for (size_t m = 0; m < set.test.size(); ++m) {
      DetectParams how;
      how.seed = seed, how.keep_votes = false;
      const SurfaceAnalysis analysis = analyse_for(params, set.test[m].mesh, how, execution);
      for (int q = 0; q < 2; ++q) {
        how.quality = qualities[q];
        const double error = mean_error(set.test[m], detect(model, analysis, how, execution).landmarks);
        Errors& sums = errors[set.name + "/" + set.test_names[m]];
        sums.sum[q][p] += error, sums.turned[q][p] += error > 8;
      }
    }
  }
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void print_comparison(const std::string& name, const MeshErrors& errors, int seeds) {
  for (int q = 0; q < 2; ++q) {
    std::vector<double> proxy, difference, means;
    int turned[2] = {};
    for (const auto& [mesh, e] : errors) {
      for (int p = 0; p < 2; ++p) turned[p] += e.turned[q][p];
      proxy.push_back(e.sum[q][0] / seeds);
      difference.push_back((e.sum[q][0] - e.sum[q][1]) / seeds);
    }
    Random random(1);
    for (int draw = 0; draw < 10000; ++draw) {
      double sum = 0;
      for (size_t i = 0; i < difference.size(); ++i)
        sum += difference[random.below(static_cast<uint32_t>(difference.size()))];
      means.push_back(sum / static_cast<double>(difference.size()));
    }
    std::sort(means.begin(), means.end());
    std::printf(
        "%-14s %-12s %3zu meshes: proxy %.3f edges, less full resolution %+.3f, 95 %% in %+.3f .. %+.3f; "
        "turned %d, %d\n",
        name.c_str(), q ? "interactive" : "best", difference.size(), mean_of(proxy), mean_of(difference),
        means[250], means[9750], turned[0], turned[1]);
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) try {
  int seeds = 3, threads = 2;
  std::vector<std::string> sets = {"scape",     "faust5k",   "faust12k",      "human07",
                                   "teddy",     "ant",       "hand",          "lion",
                                   "tosca_cat", "tosca_dog", "tosca_michael", "makehuman"};
  CLI::App app("what the proxy costs in accuracy, over all evaluation sets");
  app.add_option("--seeds", seeds)->check(CLI::PositiveNumber);
  app.add_option("--threads", threads)->check(CLI::PositiveNumber);
  app.add_option("--sets", sets)->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  MeshErrors all;
  for (const auto& name : sets) {
    const auto set = focal_bench::marked_set(name);
    if (!set) throw std::runtime_error("no set " + name + " in FOCAL_EVALUATION_DATA");
    MeshErrors errors;
    for (int seed = 0; seed < seeds; ++seed) add_errors(*set, static_cast<uint64_t>(seed), threads, errors);
    print_comparison(name, errors, seeds);
    all.merge(errors);
  }
  print_comparison("all", all, seeds);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "focal_bench_proxy: %s\n", error.what());
  return 1;
}
