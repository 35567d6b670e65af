// focal_bench_backend: a GPU's stages by its own clock with the least that each must do, whole detections beside the CPU's,
// and many meshes at once. Without a device it says so and ends with 77.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>

#include "analysis/device_surface.h"
#include "compute/module_loader.h"
#include "landmarks/detect.h"
#include "landmarks/features.h"
#include "mesh/proxy.h"
#include "subject.h"
#include "timing.h"

namespace {

using namespace focal;
using namespace focal_bench;

struct Options {
  std::string driver = "libcuda.so.1", module = FOCAL_MODULE;
  int32_t device = 0, vertices = 12500, batch_vertices = 5000, batch = 64, threads = 8, runs = 9;
  double peak_gflops = 0, peak_gigabytes = 0;  // of the device's data sheet; 0: unknown
};

Execution on(const Backend* backend, int threads) {
  Execution execution;
  execution.thread_count = threads, execution.backend = backend;
  return execution;
}

// Medians over the runs, stages of one name in one run added up.
void time_stages(const Backend& backend, const LandmarkModel& model,
                 const std::shared_ptr<const PreparedMesh>& mesh, const Options& options) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<ComputeStage>> stages;
  for (int run = 0; run <= options.runs; ++run) {
    const SurfaceAnalysis analysis = analyse_for(model.params, mesh, {}, on(&backend, 1));
    if (!analysis.engine->is_device()) return std::printf("this mesh does not suit the device\n"), void();
    const auto count = static_cast<int32_t>(analysis.samples.size());
    StageSeconds seconds;
    analysis.engine->votes(analysis, model, features_of(analysis, count, model.params, Matrix3::Identity()),
                           {}, seconds);
    std::map<std::string, ComputeStage> sums;
    for (const ComputeStage& stage : analysis.engine->stages()) {
      ComputeStage& sum = sums[stage.name];
      sum.milliseconds += stage.milliseconds, sum.flops += stage.flops, sum.bytes += stage.bytes;
      if (std::find(order.begin(), order.end(), stage.name) == order.end()) order.emplace_back(stage.name);
    }
    if (run > 0)  // the first is a rehearsal
      for (const auto& [name, sum] : sums) stages[name].push_back(sum);
    if (run == 0) std::printf("\nanalysed: %d vertices\n", analysis.surface().vertex_count());
  }
  std::printf("%-18s %9s %9s %9s %9s %9s %9s\n", "stage", "ms", "GFLOP", "MB", "GFLOP/s", "GB/s", "floor ms");
  for (const std::string& name : order) {
    std::vector<double> times;
    for (const ComputeStage& stage : stages[name]) times.push_back(stage.milliseconds);
    const double ms = median(times), flops = stages[name][0].flops, bytes = stages[name][0].bytes;
    std::printf("%-18s %9.3f %9.3f %9.2f %9.1f %9.1f ", name.c_str(), ms, flops / 1e9, bytes / 1e6,
                flops / ms / 1e6, bytes / ms / 1e6);
    if (options.peak_gflops > 0 && options.peak_gigabytes > 0)
      std::printf("%9.3f\n", std::max(flops / options.peak_gflops, bytes / options.peak_gigabytes) / 1e6);
    else
      std::printf("%9s\n", "-");
  }
}

void time_detection(const Backend& backend, const std::shared_ptr<const LandmarkModel>& model,
                    const std::shared_ptr<const PreparedMesh>& mesh, const Options& options) {
  DetectParams quick;
  quick.quality = Quality::interactive;
  for (const DetectParams& params : {DetectParams{}, quick}) {
    const char* name = params.quality == Quality::best ? "best" : "interactive";
    Detection last;
    bool by_backend = true;
    const auto seconds =
        medians_in_turn(options.runs, {[&] {
                                         last = detect(model, mesh, params, on(&backend, 2));
                                         by_backend &= last.by_backend;
                                       },
                                       [&] { detect(model, mesh, params, on(nullptr, 2)); }});
    const StageSeconds& s = last.seconds;
    std::printf("\ndetect, %s: %.1f ms, CPU %.1f ms%s\n", name, 1e3 * seconds[0].wall, 1e3 * seconds[1].wall,
                by_backend ? "" : " (the GPU failed: both are the CPU's)");
    std::printf(
        "  of these in ms: proxy %.1f, geodesics %.1f, spectrum %.1f, descriptors %.1f, votes %.1f, "
        "constellation %.1f, "
        "refine %.1f\n",
        1e3 * s.proxy, 1e3 * s.geodesics, 1e3 * s.spectrum, 1e3 * s.descriptors, 1e3 * (s.vote + s.forest),
        1e3 * s.constellation, 1e3 * s.refine);
  }
}

void time_batch(const Backend& backend, const std::shared_ptr<const LandmarkModel>& model,
                const std::shared_ptr<const PreparedMesh>& mesh, const Options& options) {
  DetectParams params;
  params.quality = Quality::interactive;
  const auto seconds =
      medians_in_turn(std::min(options.runs, 3), {[&] {
                        parallel_for(on(nullptr, options.threads), options.batch,
                                     [&](int64_t) { detect(model, mesh, params, on(&backend, 1)); });
                      }});
  std::printf("\nbatch: %d meshes of %d vertices, %d threads: %.1f meshes/s\n", options.batch,
              mesh->surface.vertex_count(), options.threads, options.batch / seconds[0].wall);
}

int run(const Options& options) {
  const LoadedBackend loaded = load_backend({options.driver, options.module}, options.device);
  if (!loaded.backend) return std::printf("skipped: no device (%s)\n", loaded.reason.c_str()), 77;
  std::printf("%s\n", loaded.backend->reason());
  const Subject subject = sample_people(6, options.vertices),
                small = sample_people(2, options.batch_vertices);
  TrainParams params;
  params.learns_confidence = false, params.augmented_copies = 0;
  const auto model = trained(subject, params, options.threads);
  const auto mesh = std::make_shared<const PreparedMesh>(prepare(subject.test));
  time_stages(*loaded.backend, *model, mesh, options);
  time_detection(*loaded.backend, model, mesh, options);
  time_batch(*loaded.backend, model, std::make_shared<const PreparedMesh>(prepare(small.test)), options);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("A GPU's stages, whole detections and batches");
  app.add_option("--driver", options.driver, "Driver library");
  app.add_option("--module", options.module, "The module (default: that of this build)");
  app.add_option("--device", options.device, "Number of the device");
  app.add_option("--vertices", options.vertices, "Of the mesh");
  app.add_option("--batch", options.batch, "Meshes at once");
  app.add_option("--batch-vertices", options.batch_vertices, "Of each of them");
  app.add_option("--threads", options.threads, "Threads that detect at once");
  app.add_option("--runs", options.runs, "Of which medians are taken");
  app.add_option("--peak-gflops", options.peak_gflops, "Double precision, of the data sheet: for the floors");
  app.add_option("--peak-gigabytes", options.peak_gigabytes, "A second, of the data sheet: for the floors");
  CLI11_PARSE(app, argc, argv);
  return run(options);
}
