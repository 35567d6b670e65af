// Tables 1 and 2: time and errors.
#include <cmath>

#include "page.h"
#include "study.h"

namespace paper {
namespace {

std::string named(const Study& study) { return study.set.name + (study.quick ? " (few shapes)" : ""); }

double mean_error(const Study& study, focal_preset preset, const std::vector<std::string>& landmarks) {
  double sum = 0, count = 0;
  for (size_t shape = 0; shape < study.set.test.size(); ++shape) {
    const Marked& marked = study.set.test[shape];
    for (const std::string& name : landmarks) {
      if (!marked.marks.contains(name)) continue;
      sum += error_of(study.detections[study.place(preset)][shape], question_about(marked, name)), ++count;
    }
  }
  return count > 0 ? sum / count : NAN;
}

std::string in_words(const std::vector<std::string>& names) {
  std::string words;
  for (const std::string& name : names) words += (words.empty() ? "" : ", ") + name;
  return words.empty() ? "none" : words;
}

}  // namespace

std::string performance(const std::vector<Study>& studies) {
  std::vector<std::vector<std::string>> rows = {
      {"set", "vertices", "shapes", "preset", "training: descriptors, a shape", "geodesics, a shape",
       "forests", "detection: descriptors", "geodesics", "forest", "voting", "in all"}};
  for (const Study& study : studies) {
    const auto shapes = static_cast<double>(study.set.train.size());
    const std::vector<std::string> what = {named(study),
                                           std::to_string(study.test().mesh.info().vertex_count),
                                           std::to_string(study.set.train.size())};
    const auto add_row = [&](const std::string& whose, const std::vector<double>& seconds) {
      rows.push_back(what);
      rows.back().push_back(whose);
      for (const double s : seconds) rows.back().push_back(fixed(s, 2));
    };
    for (const focal_preset preset : kPresets) {
      StageSeconds learning = study.training_seconds[study.place(preset)];
      const focal_stage_seconds s = study.found(preset).seconds();
      add_row(
          preset == FOCAL_PRESET_PAPER ? "paper" : "default",
          {learning["analysis"] / shapes, learning["distances"] / shapes, learning["forest"],
           s.spectrum + s.descriptors, s.geodesics, s.forest, s.vote + s.constellation + s.refine, s.total});
    }
    if (const PaperSeconds* told = paper_seconds_of(study.set.name))
      add_row("as printed",
              {told->descriptors, told->geodesics, told->forests, told->descriptors_of_test,
               told->geodesics_of_test, told->forest_of_test, told->voting,
               told->descriptors_of_test + told->geodesics_of_test + told->forest_of_test + told->voting});
  }
  return section(
      "Table 1: seconds",
      "On " + std::to_string(studies.front().context.thread_count()) +
          " threads; as printed: on a 3.4 GHz Core i7 and a GeForce GTX 780, human 12.5K, teddy 12.5K, "
          "lion 5K, ant 7.5K, hand 8.7K vertices.",
      "forests and geodesics of all landmarks of a set together, where the paper gives those of one point; "
      "the "
      "descriptors include the eigenpairs; no graphics card is used; geodesics are solved where they are "
      "used, so with preset paper those of a detection count to the voting.",
      table(rows));
}

std::string errors(const std::vector<Study>& studies) {
  std::vector<std::vector<std::string>> rows = {
      {"set", "preset", "points 1", "error 1", "points 2", "error 2", "points 3", "error 3", "mean"}};
  std::string names;
  for (const Study& study : studies) {
    const Kinds& kinds = study.set.kinds;
    for (const focal_preset preset : kPresets)
      rows.push_back({named(study), preset == FOCAL_PRESET_PAPER ? "paper" : "default",
                      std::to_string(kinds.tips.size()), fixed(mean_error(study, preset, kinds.tips), 2),
                      std::to_string(kinds.between.size()),
                      fixed(mean_error(study, preset, kinds.between), 2), std::to_string(kinds.flat.size()),
                      fixed(mean_error(study, preset, kinds.flat), 2),
                      fixed(mean_error(study, preset, kinds.all()), 2)});
    if (const PaperErrors* told = paper_errors_of(study.set.name)) {
      const auto cell = [](double error) { return error < 0 ? std::string("-") : fixed(error, 2); };
      rows.push_back({named(study), "as printed", "", cell(told->tips), "", cell(told->between), "",
                      cell(told->flat), cell(told->mean)});
    }
    names += "<li>" + study.set.name + ": 1 " + in_words(kinds.tips) + "; 2 " + in_words(kinds.between) +
             "; 3 " + in_words(kinds.flat) + "</li>";
  }
  return section(
      "Table 2: errors by kind of point",
      "In mean edge lengths of the test mesh. Kind 1: tips; kind 3: flat places; kind 2: what lies "
      "between. The points of each set by name:<ul>" +
          names + "</ul>",
      "the points are the nearest to the paper's that the sets have marks for, and the shapes are "
      "remeshed ones of the same sources. The paper does not say how the symmetry plane's normal is "
      "pointed on a new shape; here both ways vote and the stronger wins, and where the plane does "
      "not divide a bent body, left and right can change places.",
      table(rows));
}

}  // namespace paper
