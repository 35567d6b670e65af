// focal_bench_cancel: every long call on meshes of 100,000 vertices is cancelled at random moments; prints how long it
// still ran, and the share that had answered within 100 ms. As a host calls: through the C interface.
// The later moments of a whole run are tried as often as the early ones, but no longer than 30 s are waited for one.
#include <focal/focal.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

extern "C" {
#include "rigged_shape.h"
#include "shapes.h"
}

namespace {

using Clock = std::chrono::steady_clock;
using Call = std::function<focal_status(focal_task*)>;

void insist(focal_status status) {
  if (status == FOCAL_OK) return;
  std::fprintf(stderr, "focal_bench_cancel: %s: %s\n", focal_status_name(status), focal_last_error());
  std::exit(2);
}

struct Subjects {
  focal_context* context = nullptr;
  shape body;
  unsigned char* rigged_file = nullptr;
  size_t rigged_size = 0;
  focal_mesh *mesh = nullptr, *other = nullptr, *rigged = nullptr;
  focal_training_set *set = nullptr, *rigs = nullptr;
  focal_model *model = nullptr, *full = nullptr, *paper = nullptr, *rig_model = nullptr;
  focal_analysis* analysis = nullptr;
  focal_detection *detection = nullptr, *other_detection = nullptr, *rig_detection = nullptr;
};

template <class Object>
void drop(Object* object, focal_status (*destroy)(Object*)) {
  insist(destroy(object));
}

focal_train_params quick(focal_preset preset, int32_t proxy_vertices) {
  focal_train_params params;
  insist(focal_train_params_init(&params, sizeof params));
  insist(focal_train_params_set_preset(&params, preset));
  params.learn_confidence = 0, params.tree_count = 4, params.proxy_vertices = proxy_vertices;
  params.eigenpair_count = 60;
  return params;
}

Subjects make_subjects(int rings, int threads) {
  Subjects s;
  focal_context_params params;
  insist(focal_context_params_init(&params, sizeof params));
  params.thread_count = threads;
  insist(focal_context_create(&params, &s.context));
  s.body = shape_create(rings, 0.05f);
  s.mesh = shape_mesh(s.context, rings, 0.05f), s.other = shape_mesh(s.context, rings, 0.02f);
  s.rigged_file = rigged_glb(rings, 0, &s.rigged_size);
  insist(focal_mesh_load_gltf_memory(s.context, s.rigged_file, s.rigged_size, nullptr, &s.rigged));
  s.set = shape_training_set(s.context, rings, 3);
  insist(focal_training_set_create(s.context, nullptr, 0, &s.rigs));
  insist(focal_training_set_add_rig(s.rigs, s.rigged));
  insist(focal_model_train(s.set, nullptr, nullptr, &s.model));
  insist(focal_model_train(s.rigs, nullptr, nullptr, &s.rig_model));
  // What detects at full resolution is learned from small meshes here, so that it does not take minutes.
  focal_training_set* const small = shape_training_set(s.context, 30, 3);
  const focal_train_params whole = quick(FOCAL_PRESET_DEFAULT, 0), paper = quick(FOCAL_PRESET_PAPER, 0);
  insist(focal_model_train(small, &whole, nullptr, &s.full));
  insist(focal_model_train(small, &paper, nullptr, &s.paper));
  drop(small, focal_training_set_destroy);
  insist(focal_model_analyse(s.model, s.mesh, nullptr, nullptr, &s.analysis));
  insist(focal_model_detect(s.model, s.mesh, nullptr, nullptr, &s.detection));
  insist(focal_model_detect(s.model, s.other, nullptr, nullptr, &s.other_detection));
  insist(focal_model_detect(s.rig_model, s.rigged, nullptr, nullptr, &s.rig_detection));
  return s;
}

// What the call gives is dropped at once.
template <class Object>
focal_status dropped(focal_status status, Object*& object, focal_status (*destroy)(Object*)) {
  if (status == FOCAL_OK) drop(object, destroy);
  object = nullptr;
  return status;
}

std::vector<std::pair<std::string, Call>> loading_calls(const Subjects& s) {
  const auto params_with = [](focal_task* task) {
    focal_mesh_params params;
    insist(focal_mesh_params_init(&params, sizeof params));
    params.task = task;
    return params;
  };
  return {{"mesh from arrays",
           [&s, params_with](focal_task* task) {
             const focal_mesh_desc desc = shape_desc(&s.body);
             const focal_mesh_params params = params_with(task);
             focal_mesh* mesh = nullptr;
             return dropped(focal_mesh_create(s.context, &desc, &params, &mesh), mesh, focal_mesh_destroy);
           }},
          {"glTF", [&s, params_with](focal_task* task) {
             const focal_mesh_params params = params_with(task);
             focal_mesh* mesh = nullptr;
             return dropped(
                 focal_mesh_load_gltf_memory(s.context, s.rigged_file, s.rigged_size, &params, &mesh), mesh,
                 focal_mesh_destroy);
           }}};
}

Call training(const focal_training_set* set, focal_preset preset) {
  return [=](focal_task* task) {
    focal_train_params params;
    insist(focal_train_params_init(&params, sizeof params));
    insist(focal_train_params_set_preset(&params, preset));
    focal_model* model = nullptr;
    return dropped(focal_model_train(set, &params, task, &model), model, focal_model_destroy);
  };
}

Call detection(const focal_model* model, const focal_mesh* mesh) {
  return [=](focal_task* task) {
    focal_detection* found = nullptr;
    return dropped(focal_model_detect(model, mesh, nullptr, task, &found), found, focal_detection_destroy);
  };
}

std::vector<std::pair<std::string, Call>> landmark_calls(const Subjects& s) {
  return {{"train", training(s.set, FOCAL_PRESET_DEFAULT)},
          {"train on a rig", training(s.rigs, FOCAL_PRESET_DEFAULT)},
          {"train paper", training(s.set, FOCAL_PRESET_PAPER)},
          {"detect", detection(s.model, s.mesh)},
          {"detect, full resolution", detection(s.full, s.mesh)},
          {"detect paper", detection(s.paper, s.mesh)},
          {"analyse",
           [&s](focal_task* task) {
             focal_analysis* made = nullptr;
             return dropped(focal_model_analyse(s.model, s.mesh, nullptr, task, &made), made,
                            focal_analysis_destroy);
           }},
          {"detect on an analysis", [&s](focal_task* task) {
             focal_detection* found = nullptr;
             return dropped(focal_model_detect_analysis(s.model, s.analysis, nullptr, task, &found), found,
                            focal_detection_destroy);
           }}};
}

std::vector<std::pair<std::string, Call>> result_calls(const Subjects& s) {
  return {{"correspondence",
           [&s](focal_task* task) {
             focal_correspondence* map = nullptr;
             return dropped(focal_correspondence_create(s.detection, s.other_detection, task, &map), map,
                            focal_correspondence_destroy);
           }},
          {"segments",
           [&s](focal_task* task) {
             std::vector<int32_t> labels(s.body.index_count / 3);
             return focal_detection_segment(s.detection, FOCAL_SEGMENTATION_GEODESIC, task, labels.size(),
                                            labels.data());
           }},
          {"skeleton", [&s](focal_task* task) {
             focal_skeleton_params params;
             insist(focal_skeleton_params_init(&params, sizeof params));
             params.symmetric = 1, params.rest_pose = 1, params.animations = s.rigged;
             focal_skeleton* made = nullptr;
             return dropped(focal_skeleton_create(s.rig_detection, &params, task, &made), made,
                            focal_skeleton_destroy);
           }}};
}

std::vector<std::pair<std::string, Call>> measuring_calls(const Subjects& s) {
  std::vector<std::pair<std::string, Call>> calls;
  for (focal_descriptor d = 0; d < static_cast<focal_descriptor>(focal_descriptor_count()); ++d)
    calls.emplace_back(std::string("descriptor ") + focal_descriptor_name(d), [&s, d](focal_task* task) {
      std::vector<uint32_t> vertices(1000);
      for (uint32_t i = 0; i < vertices.size(); ++i) vertices[i] = 7 * i;
      std::vector<float> values(vertices.size() * static_cast<size_t>(focal_descriptor_dimension(d)));
      return focal_mesh_describe(s.context, s.mesh, d, vertices.data(), vertices.size(), task, values.data());
    });
  for (focal_distance d = 0; d < static_cast<focal_distance>(focal_distance_count()); ++d)
    calls.emplace_back(std::string("distance ") + focal_distance_name(d), [&s, d](focal_task* task) {
      const focal_surface_point source = {0, {1, 0, 0}};
      std::vector<float> values(s.body.vertex_count);
      return focal_mesh_distances(s.context, s.mesh, d, &source, task, values.size(), values.data());
    });
  calls.emplace_back("symmetry plane", [&s](focal_task* task) {
    focal_symmetry_plane plane;
    insist(focal_symmetry_plane_init(&plane, sizeof plane));
    return focal_mesh_symmetry_plane(s.context, s.mesh, 1, task, &plane);
  });
  return calls;
}

struct Answers {
  std::vector<double> seconds;            // from the cancel to the return
  std::map<std::string, double> slowest;  // by the stage
};

double run_whole(const Call& call, double most) {
  focal_task* task = nullptr;
  insist(focal_task_create(&task));
  const auto start = Clock::now();
  std::thread stopper([&] {
    while (focal_task_progress(task) < 1 && !focal_task_is_cancelled(task) &&
           std::chrono::duration<double>(Clock::now() - start).count() < most)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    focal_task_cancel(task);
  });
  const focal_status status = call(task);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  insist(focal_task_cancel(task));
  stopper.join();
  if (status != FOCAL_ERROR_CANCELLED) insist(status);
  drop(task, focal_task_destroy);
  return seconds;
}

void cancel_after(const Call& call, double delay, Answers& answers) {
  focal_task* task = nullptr;
  insist(focal_task_create(&task));
  Clock::time_point cancelled;
  std::string stage;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::duration<double>(delay));
    stage = focal_task_stage(task);
    cancelled = Clock::now();
    focal_task_cancel(task);
  });
  const focal_status status = call(task);
  const Clock::time_point returned = Clock::now();
  canceller.join();
  drop(task, focal_task_destroy);
  if (status == FOCAL_OK) return;  // it had ended before
  if (status != FOCAL_ERROR_CANCELLED) insist(status);
  const double seconds = std::chrono::duration<double>(returned - cancelled).count();
  answers.seconds.push_back(seconds);
  double& slowest = answers.slowest[stage];
  slowest = std::max(slowest, seconds);
}

size_t in_time(const std::vector<double>& seconds) {
  return static_cast<size_t>(
      std::count_if(seconds.begin(), seconds.end(), [](double s) { return s <= 0.1; }));
}

void tell(const std::string& name, double whole, Answers& answers) {
  auto& seconds = answers.seconds;
  if (seconds.empty())
    return void(std::printf("%-26s %7.3f s, ended before every cancel\n", name.c_str(), whole));
  std::sort(seconds.begin(), seconds.end());
  const auto at = [&](double share) {
    return 1e3 * seconds[static_cast<size_t>(share * static_cast<double>(seconds.size() - 1))];
  };
  std::printf(
      "%-26s %7.3f s, %4zu cancelled: %5.1f %% within 100 ms; half within %3.0f ms, 99 %% %4.0f, all %4.0f",
      name.c_str(), whole, seconds.size(),
      100.0 * static_cast<double>(in_time(seconds)) / static_cast<double>(seconds.size()), at(0.5), at(0.99),
      at(1));
  for (const auto& [stage, slowest] : answers.slowest)
    if (slowest > 0.1) std::printf("  [%s %.0f]", stage.c_str(), 1e3 * slowest);
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  int rings = 222, runs = 200, threads = 2;
  double most = 30;
  std::string only;
  CLI::App app("how soon long calls end when they are cancelled");
  app.add_option("--rings", rings, "Of the meshes: 222 for 100,000 vertices")->check(CLI::Range(7, 1000));
  app.add_option("--runs", runs, "Cancellations of each call")->check(CLI::PositiveNumber);
  app.add_option("--threads", threads)->check(CLI::PositiveNumber);
  app.add_option("--most", most, "Seconds that are waited for a cancel at most")->check(CLI::PositiveNumber);
  app.add_option("--only", only, "Calls whose names hold this");
  CLI11_PARSE(app, argc, argv);
  const Subjects subjects = make_subjects(rings, threads);
  std::printf("%llu vertices, %d threads\n", static_cast<unsigned long long>(subjects.body.vertex_count),
              threads);
  std::fflush(stdout);
  std::mt19937 random(1);
  std::vector<double> all;
  for (const auto& calls :
       {loading_calls(subjects), landmark_calls(subjects), result_calls(subjects), measuring_calls(subjects)})
    for (const auto& [name, call] : calls) {
      if (name.find(only) == std::string::npos) continue;
      const double whole = run_whole(call, most);
      Answers answers;
      for (int run = 0; run < runs; ++run)
        cancel_after(call, whole * std::uniform_real_distribution<double>(0, 1)(random), answers);
      tell(name, whole, answers);
      all.insert(all.end(), answers.seconds.begin(), answers.seconds.end());
    }
  std::printf(
      "%zu cancellations, %zu answered within 100 ms (%.2f %%)\n", all.size(), in_time(all),
      100.0 * static_cast<double>(in_time(all)) / static_cast<double>(std::max<size_t>(all.size(), 1)));
  return 0;
}
