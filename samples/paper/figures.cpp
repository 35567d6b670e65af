// The figures. The numbers are those of the paper: Xia, Li, Song et al., "Automatic Extraction of Generic Focal Features on
// 3D Shapes via Random Forest Regression Analysis of Geodesics-in-Heat", 2016.
#include "figures.h"

#include <algorithm>
#include <functional>

#include "damage.h"
#include "picture/surface.h"

namespace paper {
namespace {

constexpr std::array kPresets = {FOCAL_PRESET_PAPER, FOCAL_PRESET_DEFAULT};

// Both models, and what each finds on the test shape.
struct Models {
  focal::Model paper, standard;
  focal::Detection by_paper, by_standard;
  const focal::Detection& found(focal_preset preset) const {
    return preset == FOCAL_PRESET_PAPER ? by_paper : by_standard;
  }
  const focal::Model& of(focal_preset preset) const {
    return preset == FOCAL_PRESET_PAPER ? paper : standard;
  }
};

Question question_about(const Marked& marked, const std::string& landmark) {
  return {landmark, place_of(marked, landmark), marked.mesh.info().mean_edge_length};
}

std::string label_of(focal_preset preset, const std::string& words) {
  return std::string(preset == FOCAL_PRESET_PAPER ? "paper" : "default") + ", " + words;
}

std::string section(const std::string& title, const std::string& words,
                    const std::vector<picture::Figure>& figures, size_t columns) {
  return "<section><h3>" + title + "</h3><p>" + words + "</p>" + picture::draw(figures, columns) +
         "</section>\n";
}

// A landmark that has a mirror where there is one: the harder question.
std::string main_landmark(const Set& set) {
  for (const std::string& name : set.landmarks) {
    for (const auto& [one, other] : set.mirror) {
      if (one != other && (name == one || name == other) && set.test[0].marks.contains(name)) return name;
    }
  }
  return set.landmarks.front();
}

std::string by_samples(const Set& set, const Models& models) {
  std::vector<picture::Figure> figures;
  const std::vector<int32_t> counts = {3, 10, 30, 100, 1250};
  const Question question = question_about(set.test[0], main_landmark(set));
  for (const focal_preset preset : kPresets) {
    for (const int32_t count : counts) {
      figures.push_back(vote_figure(detect(models.of(preset), set.test[0].mesh, count), set.test[0].mesh,
                                    question, label_of(preset, std::to_string(count))));
    }
  }
  return section("Votes as the samples grow",
                 "Landmark " + question.landmark + ", so many points of the surface vote (as in Fig. 7c).",
                 figures, counts.size());
}

std::string by_training(const focal::Context& context, const Set& set, const Models& models) {
  std::vector<picture::Figure> figures;
  std::vector<size_t> counts = {2, 4, set.train.size()};
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  const Question question = question_about(set.test[0], main_landmark(set));
  for (const focal_preset preset : kPresets) {
    for (const size_t count : counts) {
      const bool all = count == set.train.size();
      const focal::Detection of_few =
          all ? focal::Detection() : detect(learn(context, set, count, preset), set.test[0].mesh);
      figures.push_back(vote_figure(all ? models.found(preset) : of_few, set.test[0].mesh, question,
                                    label_of(preset, std::to_string(count))));
    }
  }
  return section("Votes as the training shapes grow",
                 "Landmark " + question.landmark + ", learned from so many shapes (as in Fig. 7b).", figures,
                 counts.size());
}

std::string by_landmark(const Set& set, const Models& models) {
  std::vector<std::string> names;
  const size_t step = std::max<size_t>(1, set.landmarks.size() / 5);
  for (size_t i = 0; i < set.landmarks.size() && names.size() < 5; i += step) {
    if (set.test[0].marks.contains(set.landmarks[i])) names.push_back(set.landmarks[i]);
  }
  std::vector<picture::Figure> figures;
  for (const focal_preset preset : kPresets) {
    for (const std::string& name : names) {
      const Question question = question_about(set.test[0], name);
      figures.push_back(
          vote_figure(models.found(preset), set.test[0].mesh, question, label_of(preset, name)));
    }
  }
  return section("Tips, joints and flat places", "One landmark a column (as in Figs. 8 and 9).", figures,
                 names.size());
}

std::string look_alikes(const Set& set, const Models& models) {
  const std::string one = main_landmark(set);
  std::string other;
  for (const auto& [a, b] : set.mirror) {
    if (a != b && (a == one || b == one)) other = a == one ? b : a;
  }
  if (other.empty() || !set.test[0].marks.contains(other)) return "";
  std::vector<picture::Figure> figures;
  for (const std::string& name : {one, other}) {
    for (const focal_preset preset : kPresets) {
      const Question question = question_about(set.test[0], name);
      figures.push_back(
          vote_figure(models.found(preset), set.test[0].mesh, question, label_of(preset, name)));
    }
  }
  picture::Figure both = figures.front();  // all are seen from where both sides are
  both.marks = {{"one", place_of(set.test[0], one)}, {"other", place_of(set.test[0], other)}};
  const double yaw = picture::best_yaw(both);
  for (picture::Figure& figure : figures) figure.yaw = yaw;
  return section(
      "Left or right",
      "The same surface asked for a landmark and for its mirror image: votes that cannot tell them "
      "apart are as red on the wrong side (Fig. 3 is about this).",
      figures, 4);
}

using Change = std::pair<std::string, std::function<Shape(const Shape&)>>;

std::string by_change(const focal::Context& context, const Set& set, const Models& models,
                      const std::string& title, const std::string& words,
                      const std::vector<Change>& changes) {
  const Shape clean = shape_of(set.test[0].mesh);
  const Question asked = question_about(set.test[0], main_landmark(set));
  std::vector<picture::Figure> figures;
  for (const focal_preset preset : kPresets) {
    for (const auto& [label, change] : changes) {
      const Shape shape = change(clean);
      Question question = asked;
      const double factor = label == "100 x" ? 100 : 1;  // errors in the clean mesh's edges, grown with it
      for (double& x : question.truth) x *= factor;
      question.edge *= factor;
      const focal::Mesh mesh = mesh_of(context, shape);
      figures.push_back(
          vote_figure(detect(models.of(preset), mesh), mesh, question, label_of(preset, label)));
    }
  }
  for (picture::Figure& figure : figures) figure.yaw = figures.front().yaw;
  return section(title, words, figures, changes.size());
}

std::string by_damage(const focal::Context& context, const Set& set, const Models& models) {
  const std::vector<Change> changes = {
      {"clean", [](const Shape& s) { return s; }},
      {"noise", [](const Shape& s) { return with_noise(s, 0.3 * mean_edge(s), 1); }},
      {"holes", [](const Shape& s) { return with_holes(s, 60, 1); }},
      {"100 x", [](const Shape& s) { return scaled(s, 100); }}};
  return by_change(context, set, models, "Noise, holes, scale",
                   "Noise of 0.3 edges in every coordinate, 60 holes of one vertex each, a hundred times the "
                   "size (as in Fig. 10).",
                   changes);
}

std::string by_resolution(const focal::Context& context, const Set& set, const Models& models) {
  const std::vector<Change> changes = {{"quarter", [](const Shape& s) { return resampled(s, 0.25); }},
                                       {"half", [](const Shape& s) { return resampled(s, 0.5); }},
                                       {"as it is", [](const Shape& s) { return s; }},
                                       {"fourfold", [](const Shape& s) { return resampled(s, 4); }}};
  return by_change(context, set, models, "Resolution",
                   "A quarter, half, all and four times the triangles (as in Fig. 11).", changes);
}

}  // namespace

std::string figures_of(const focal::Context& context, const Set& set) {
  Models models{learn(context, set, set.train.size(), FOCAL_PRESET_PAPER),
                learn(context, set, set.train.size(), FOCAL_PRESET_DEFAULT), focal::Detection(),
                focal::Detection()};
  models.by_paper = detect(models.paper, set.test[0].mesh);
  models.by_standard = detect(models.standard, set.test[0].mesh);
  return by_samples(set, models) + by_training(context, set, models) + look_alikes(set, models) +
         by_landmark(set, models) + by_damage(context, set, models) + by_resolution(context, set, models);
}

}  // namespace paper
