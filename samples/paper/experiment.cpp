// A set of marked meshes, models of it, and one detection as a figure. See experiment.h.
#include "experiment.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "picture/surface.h"

namespace paper {
namespace {

using Json = nlohmann::json;

Json read_json(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  return Json::parse(file);
}

Marked load_marked(const focal::Context& context, const std::string& folder, const std::string& name) {
  Marked marked{name, focal::Mesh(context, folder + "/" + name + ".glb"), {}};
  const Json file = read_json(folder + "/" + name + ".landmarks.json");
  for (const Json& mark : file.at("landmarks")) {
    focal_surface_point point{};
    if (mark.contains("triangle")) {
      point.triangle = mark["triangle"];
      for (size_t k = 0; k < 3; ++k) point.barycentric[k] = mark.at("barycentric")[k];
    } else {
      focal::check(focal_mesh_point_at_vertex(marked.mesh.get(), mark.at("vertex"), &point));
    }
    marked.marks[mark.at("name")] = point;
  }
  return marked;
}

// Looks down on what lies flat.
double pitch_of(const picture::Figure& figure) {
  picture::Point low = figure.positions.at(0), high = low;
  for (const picture::Point& p : figure.positions) {
    for (size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  }
  return 2 * (high[1] - low[1]) < std::max(high[0] - low[0], high[2] - low[2]) ? 50 : 10;
}

double apart(const picture::Point& a, const picture::Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Turns it to show most of the surface around a point, with nothing in front of the point; from below where that shows much more.
void turn_towards(picture::Figure& shown_figure, const picture::Point& point) {
  picture::Figure figure = shown_figure;
  double radius = 0, most = -1;
  figure.heat.resize(figure.positions.size());
  for (const picture::Point& p : figure.positions) radius = std::max(radius, apart(p, point) / 5);
  for (size_t v = 0; v < figure.positions.size(); ++v) {
    figure.heat[v] = std::exp(-std::pow(apart(figure.positions[v], point) / radius, 2));
  }
  figure.marks = {{"point", point}};
  const double level = figure.pitch;
  for (const double pitch : {level, -level}) {
    figure.pitch = pitch;
    if (pitch != level) most *= 1.5;
    for (figure.yaw = 0; figure.yaw < 360; figure.yaw += 30) {
      const picture::Panel panel = picture::fit_into_panel(figure, 1000, 1000);
      double shown = 0;
      for (const picture::Patch& patch : panel.patches) {
        const auto& [a, b, c] = patch.corners;
        shown += patch.heat * std::fabs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
      }
      if (picture::is_hidden(panel, 0)) shown /= 4;
      if (shown > 1.02 * most) most = shown, shown_figure.yaw = figure.yaw, shown_figure.pitch = pitch;
    }
  }
}

void add_surface(const focal::Mesh& mesh, picture::Figure& figure) {
  const focal_mesh_info info = mesh.info();
  const float* p = mesh.positions();
  const uint32_t* t = mesh.triangles();
  for (uint64_t i = 0; i < 3 * info.vertex_count; i += 3)
    figure.positions.push_back({p[i], p[i + 1], p[i + 2]});
  for (uint64_t i = 0; i < 3 * info.triangle_count; i += 3)
    figure.triangles.push_back({t[i], t[i + 1], t[i + 2]});
}

// Looks at a task on a thread of its own, as a progress bar does.
class StageClock {
 public:
  StageClock(const focal::Task& task, StageSeconds& seconds)
      : thread_([this, &task, &seconds] {
          for (auto last = Clock::now(); !done_;) {
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
            const auto now = Clock::now();
            seconds[task.stage()] += std::chrono::duration<double>(now - last).count();
            last = now;
          }
        }) {}
  ~StageClock() { done_ = true, thread_.join(); }

 private:
  using Clock = std::chrono::steady_clock;
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace

Set load_set(const focal::Context& context, const std::string& folder, size_t train, size_t test) {
  const Json file = read_json(folder + "/set.json");
  Set set;
  set.name = file.value("name", folder);
  set.landmarks = file.at("landmark_names").get<std::vector<std::string>>();
  if (set.name == "hand" && set.landmarks.front() == "thumbTip") set.name = "sample hand";
  set.kinds = kinds_of(set.name, set.landmarks);
  set.landmarks = set.kinds.all();
  if (file.contains("mirror")) set.mirror = file["mirror"].get<std::map<std::string, std::string>>();
  for (const Json& name : file.at("train")) {
    if (set.train.size() < train) set.train.push_back(load_marked(context, folder, name));
  }
  for (const Json& name : file.at("test")) {
    if (set.test.size() < test) set.test.push_back(load_marked(context, folder, name));
  }
  if (set.test.empty()) throw std::runtime_error(folder + " has no test mesh");
  return set;
}

focal::Model learn(const focal::Context& context, const Set& set, const Recipe& recipe,
                   StageSeconds* seconds) {
  const auto& landmarks = recipe.landmarks.empty() ? set.landmarks : recipe.landmarks;
  focal::TrainingSet training(context, landmarks);
  for (size_t i = 0; i < std::min(recipe.meshes, set.train.size()); ++i) {
    std::vector<focal_surface_point> points;
    for (const std::string& name : landmarks) {
      const auto mark = set.train[i].marks.find(name);
      points.push_back(mark == set.train[i].marks.end() ? focal_surface_point{FOCAL_NO_TRIANGLE, {1, 0, 0}}
                                                        : mark->second);
    }
    training.add(set.train[i].mesh, points);
  }
  auto params = focal::init(focal_train_params_init);
  focal::check(focal_train_params_set_preset(&params, recipe.preset));
  params.descriptor = recipe.descriptor;
  params.distance = recipe.distance;
  params.learn_confidence = 0;  // which places are found does not hang on it
  if (recipe.sampling_rate > 0) params.sampling_rate = recipe.sampling_rate;
  if (recipe.trees > 0) params.tree_count = recipe.trees;
  if (!seconds) return focal::Model(training, &params);
  focal::Task task;
  const StageClock clock(task, *seconds);
  return focal::Model(training, &params, &task);
}

picture::Point place_of(const Marked& marked, const std::string& landmark) {
  float xyz[3];
  focal::check(focal_mesh_position_of(marked.mesh.get(), &marked.marks.at(landmark), xyz));
  return {xyz[0], xyz[1], xyz[2]};
}

focal::Detection detect(const focal::Model& model, const focal::Mesh& mesh, int32_t samples) {
  auto params = focal::init(focal_detect_params_init);
  if (samples > 0) {
    params.sampling_rate = 1;
    params.max_samples = samples;
  }
  return model.detect(mesh, &params);
}

uint32_t index_of(const focal::Detection& detection, const std::string& landmark) {
  const std::vector<focal_landmark> landmarks = detection.landmarks();
  const auto found = std::find_if(landmarks.begin(), landmarks.end(),
                                  [&](const focal_landmark& l) { return l.name == landmark; });
  if (found == landmarks.end()) throw std::runtime_error("no landmark " + landmark);
  return static_cast<uint32_t>(found - landmarks.begin());
}

picture::Point found_place(const focal::Detection& detection, const std::string& landmark) {
  const focal_landmark found = detection.landmarks()[index_of(detection, landmark)];
  return {found.position[0], found.position[1], found.position[2]};
}

double error_of(const focal::Detection& detection, const Question& question) {
  return apart(found_place(detection, question.landmark), question.truth) / question.edge;
}

Question question_about(const Marked& marked, const std::string& landmark) {
  return {landmark, place_of(marked, landmark), marked.mesh.info().mean_edge_length};
}

picture::Figure surface_figure(const focal::Mesh& mesh) {
  picture::Figure figure;
  add_surface(mesh, figure);
  figure.pitch = pitch_of(figure);
  figure.triangles_drawn = 2200;
  return figure;
}

void face(picture::Figure& figure, const picture::Point& point) { turn_towards(figure, point); }

void face_marks(picture::Figure& figure, const Marked& marked) {
  picture::Figure turning = surface_figure(marked.mesh);
  for (const auto& [name, mark] : marked.marks) turning.marks.push_back({name, place_of(marked, name)});
  size_t most = 0;
  for (turning.yaw = 0; turning.yaw < 360; turning.yaw += 30) {
    const picture::Panel panel = picture::fit_into_panel(turning, 2000, 2700);
    size_t shown = 0;
    for (size_t i = 0; i < panel.marks.size(); ++i) shown += !picture::is_hidden(panel, i);
    if (shown > most) most = shown, figure.yaw = turning.yaw;
  }
}

picture::Figure vote_figure(const focal::Detection& detection, const focal::Mesh& mesh,
                            const Question& question, const std::string& label) {
  picture::Figure figure = surface_figure(mesh);
  for (const float vote : detection.votes(index_of(detection, question.landmark)))
    figure.heat.push_back(vote);
  figure.marks = {{"marked", question.truth, true, "#0a7d3c"},
                  {"found", found_place(detection, question.landmark), false, "#2563eb"}};
  char words[32];
  std::snprintf(words, sizeof words, ": %.1f", error_of(detection, question));
  figure.caption = label + words;
  return figure;
}

picture::Figure all_votes_figure(const focal::Detection& detection, const Marked& marked,
                                 const std::string& label) {
  picture::Figure figure = surface_figure(marked.mesh);
  figure.heat.assign(figure.positions.size(), 0);
  double sum = 0;
  const std::vector<focal_landmark> landmarks = detection.landmarks();
  size_t asked = 0;
  for (size_t l = 0; l < landmarks.size(); ++l) {
    const std::vector<float> votes = detection.votes(static_cast<uint32_t>(l));
    for (size_t v = 0; v < votes.size(); ++v)
      if (const double squared = votes[v] * votes[v]; squared >= 0.2)
        figure.heat[v] = std::max(figure.heat[v], squared);
    if (!marked.marks.contains(landmarks[l].name)) continue;
    sum += error_of(detection, question_about(marked, landmarks[l].name)), ++asked;
    figure.marks.push_back({landmarks[l].name, found_place(detection, landmarks[l].name), false, "#2563eb"});
  }
  char words[32];
  std::snprintf(words, sizeof words, ": %.1f", sum / static_cast<double>(std::max<size_t>(asked, 1)));
  figure.caption = label + words;
  return figure;
}

}  // namespace paper
