// focal_bench_cancel: a detection on a large mesh is cancelled at random moments; prints how long it still ran.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "base/error.h"
#include "base/random.h"
#include "large_mesh.h"
#include "stages.h"
#include "timing.h"

namespace {

using namespace focal_bench;
using Clock = std::chrono::steady_clock;

// Seconds from the cancellation to the return; negative when the detection had ended before.
double seconds_after_cancel(const std::shared_ptr<const focal::LandmarkModel>& model,
                            const std::shared_ptr<const focal::PreparedMesh>& mesh, double delay,
                            int threads) {
  focal::Task task;
  focal::Execution execution = threads_of(threads);
  execution.task = &task;
  Clock::time_point cancelled;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::duration<double>(delay));
    cancelled = Clock::now();
    task.cancel();
  });
  bool stopped = false;
  try {
    focal::detect(model, mesh, detect_variants()[0].params, execution);
  } catch (const focal::Error& error) {
    stopped = error.status() == focal::Status::cancelled;
  }
  const Clock::time_point returned = Clock::now();
  canceller.join();
  return stopped ? std::chrono::duration<double>(returned - cancelled).count() : -1;
}

}  // namespace

int main(int argc, char** argv) try {
  int32_t vertices = 125000;
  int runs = 200, threads = 2;
  CLI::App app("how soon a detection stops");
  app.add_option("--vertices", vertices)->check(CLI::PositiveNumber);
  app.add_option("--runs", runs)->check(CLI::PositiveNumber);
  app.add_option("--threads", threads)->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  const Subject subject = set_or_people("faust12k");
  const auto model =
      trained(subject, focal::TrainParams::from_preset(focal::Preset::default_preset), threads);
  const auto mesh = std::make_shared<const focal::PreparedMesh>(
      focal::prepare(resized(focal::prepare(subject.test).surface, vertices, 1)));
  const double whole =
      seconds_of([&] { focal::detect(model, mesh, detect_variants()[0].params, threads_of(threads)); }).wall;
  focal::Random random(1);
  std::vector<double> seconds;
  for (int run = 0; run < runs; ++run) {
    const double after = seconds_after_cancel(model, mesh, random.uniform() * whole, threads);
    if (after >= 0) seconds.push_back(after);
  }
  std::sort(seconds.begin(), seconds.end());
  const auto at = [&](double share) {
    return 1e3 * seconds.at(static_cast<size_t>(share * (seconds.size() - 1)));
  };
  std::printf(
      "%s at %d vertices, detection %.3f s, %zu cancellations: 50 %% within %.0f ms, 90 %% %.0f, 99 %% %.0f, "
      "all %.0f\n",
      subject.name.c_str(), vertices, whole, seconds.size(), at(0.5), at(0.9), at(0.99), at(1));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "focal_bench_cancel: %s\n", error.what());
  return 1;
}
