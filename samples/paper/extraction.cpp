// Figs. 8 and 9: all points of a shape, and each kind on its own; how many marks it takes, beside Schelling points.
#include <cmath>

#include "chart.h"
#include "page.h"
#include "study.h"

namespace paper {
namespace {

constexpr double kNear = 5;  // mean edges within which a point counts as found

std::string each_kind(const Study& study) {
  const std::vector<std::string> names = study.examples();
  std::vector<picture::Figure> figures;
  for (const focal_preset preset : kPresets)
    for (const std::string& name : names) {
      const Question question = study.question(name);
      figures.push_back(
          vote_figure(study.found(preset), study.test().mesh, question, label_of(preset, name)));
      face(figures.back(), question.truth);
    }
  return pictures(figures, figures.size());
}

// Share of the points of the test shapes that a model finds.
double found_share(const Study& study, const focal::Model& model) {
  double found = 0, asked = 0;
  for (const Marked& marked : study.set.test) {
    const focal::Detection detection = detect(model, marked.mesh);
    for (const std::string& name : study.set.landmarks)
      if (marked.marks.contains(name))
        found += error_of(detection, question_about(marked, name)) < kNear, ++asked;
  }
  return found / asked;
}

}  // namespace

std::string extraction(const Study& study) {
  std::vector<picture::Figure> figures;
  const size_t shapes = std::min<size_t>(2, study.set.test.size());
  for (size_t shape = 0; shape < shapes; ++shape)
    for (const focal_preset preset : kPresets) {
      figures.push_back(all_votes_figure(study.detections[study.place(preset)][shape], study.set.test[shape],
                                         label_of(preset, "all")));
      face_marks(figures.back(), study.set.test[shape]);
    }
  return section(
      "Figs. 8 and 9: " + study.set.name,
      "The votes of all " + std::to_string(study.set.landmarks.size()) +
          " points at once, squared, those below 0.2 left out, and a point of each kind. The caption has "
          "the mean error.",
      "", pictures(figures, figures.size()) + each_kind(study));
}

std::string few_marks(const Study& study) {
  std::vector<Curve> curves;
  std::vector<std::vector<std::string>> rows = {{"marks a point in all", "paper: found", "default: found"}};
  std::vector<size_t> counts;
  for (size_t count = 2; count <= study.set.train.size(); count += study.quick ? 2 : 1)
    counts.push_back(count);
  for (const size_t count : counts) rows.push_back({std::to_string(count)});
  for (const focal_preset preset : kPresets) {
    curves.push_back({preset == FOCAL_PRESET_PAPER ? "paper" : "default",
                      preset == FOCAL_PRESET_PAPER ? "#d97706" : "#2563eb",
                      {}});
    for (size_t i = 0; i < counts.size(); ++i) {
      const double share =
          counts[i] == study.set.train.size()
              ? found_share(study, study.model(preset))
              : found_share(study,
                            learn(study.context, study.set,
                                  {.preset = preset, .meshes = counts[i], .trees = study.quick ? 10 : 0}));
      curves.back().points.push_back({static_cast<double>(counts[i]), share});
      rows[i + 1].push_back(fixed(100 * share, 0) + " %");
    }
  }
  return section(
      "Beside Schelling points: how many marks it takes, " + study.set.name,
      "Every shape is marked once a point. Schelling points (Chen et al. 2012) learn from the clicks of "
      "many people, tens to hundreds of marks a shape, and find what people agree on: mostly tips. Here the "
      "share of the points of all kinds that lie within 5 mean edges of their marks on shapes not trained "
      "on; the pictures above are the probabilities.",
      "Schelling points are not recomputed: their method predicts where people click, not which of the "
      "points is which, so it has no error for a point by name.",
      chart("share found", "training shapes, one mark each", "", curves) + table(rows));
}

}  // namespace paper
