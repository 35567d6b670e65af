// Fig. 7: accuracy over the sampling rate in training, over the number of shapes, and votes over the rate in detection.
#include <chrono>
#include <cmath>

#include "chart.h"
#include "page.h"
#include "study.h"

namespace paper {
namespace {

constexpr std::array kPaints = {"#d92626", "#0a7d3c", "#2563eb"};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Mean square error of the regressed distances of the test shape.
double square_error(const focal::Model& model, const focal::Analysis& analysis, uint32_t landmark,
                    const focal_surface_point& truth) {
  const auto told = model.regress(analysis, landmark, truth);
  double sum = 0;
  for (size_t s = 0; s < told.truth.size(); ++s) sum += std::pow(told.truth[s] - told.regressed[s], 2);
  return sum / static_cast<double>(told.truth.size());
}

// Learns by each recipe; a curve of errors a landmark, and one of the time that training took.
std::string curves_of(const Study& study, focal_preset preset, const std::string& x,
                      const std::vector<std::pair<double, Recipe>>& recipes) {
  const std::vector<std::string> names = study.examples();
  std::vector<Curve> errors;
  for (size_t i = 0; i < names.size(); ++i) errors.push_back({names[i], kPaints[i % 3], {}});
  Curve time{"", "#444", {}};
  for (const auto& [at, recipe] : recipes) {
    const auto start = std::chrono::steady_clock::now();
    const focal::Model model = study.small_model(recipe);
    time.points.push_back({at, seconds_since(start)});
    const focal::Analysis analysis = model.analyse(study.test().mesh);
    for (size_t i = 0; i < names.size(); ++i)
      errors[i].points.push_back(
          {at, square_error(model, analysis, static_cast<uint32_t>(i), study.test().marks.at(names[i]))});
  }
  return "<div>" + chart(label_of(preset, "mean square error"), x, "", errors) +
         chart(label_of(preset, "seconds of training"), x, "", {time}) + "</div>";
}

std::string by_rate(const Study& study) {
  const std::vector<double> rates =
      study.quick ? std::vector<double>{0.1, 0.5, 1} : std::vector<double>{0.1, 0.2, 0.3, 0.5, 0.7, 1};
  std::string charts;
  for (const focal_preset preset : kPresets) {
    std::vector<std::pair<double, Recipe>> recipes;
    for (const double rate : rates) recipes.push_back({rate, {.preset = preset, .sampling_rate = rate}});
    charts += curves_of(study, preset, "sampling rate in training", recipes);
  }
  return section(
      "Fig. 7 a: how much of each training shape is sampled",
      "Mean square error of the distances that a model regresses for the test shape's sample points.",
      "preset default keeps distributions, and their mean, shown here, is no better for more samples: where "
      "a landmark has a mirror image it lies between two distances (see Fig. 5).",
      charts);
}

std::string by_shapes(const Study& study) {
  std::string charts;
  for (const focal_preset preset : kPresets) {
    std::vector<std::pair<double, Recipe>> recipes;
    for (size_t count = 2; count <= study.set.train.size(); count += study.quick ? 1 : 2)
      recipes.push_back({static_cast<double>(count), {.preset = preset, .meshes = count}});
    charts += curves_of(study, preset, "training shapes", recipes);
  }
  return section("Fig. 7 b: how many shapes are trained on", "As in part a, at the preset's rate.", "",
                 charts);
}

// Votes that sum to 1.
std::vector<float> distribution(const focal::Detection& detection, uint32_t landmark) {
  std::vector<float> votes = detection.votes(landmark);
  double sum = 0;
  for (const float vote : votes) sum += vote;
  for (float& vote : votes) vote = static_cast<float>(vote / sum);
  return votes;
}

// How much the distribution of the votes changes from one rate to the next.
std::string by_votes(const Study& study, focal_preset preset) {
  const std::vector<std::string> names = study.examples();
  const double vertices = static_cast<double>(study.test().mesh.info().vertex_count);
  std::vector<Curve> changes;
  for (size_t i = 0; i < names.size(); ++i) changes.push_back({names[i], kPaints[i % 3], {}});
  Curve time{"", "#444", {}};
  std::vector<std::vector<float>> before(names.size());
  for (const double rate : {0.02, 0.05, 0.1, 0.15, 0.2, 0.3}) {
    const auto start = std::chrono::steady_clock::now();
    const focal::Detection found =
        detect(study.model(preset), study.test().mesh, std::max(1, static_cast<int32_t>(rate * vertices)));
    time.points.push_back({rate, seconds_since(start)});
    for (size_t i = 0; i < names.size(); ++i) {
      std::vector<float> votes = distribution(found, index_of(found, names[i]));
      double squares = 0, own = 0;
      for (size_t v = 0; v < before[i].size(); ++v)
        squares += std::pow(votes[v] - before[i][v], 2), own += std::pow(votes[v], 2);
      if (!before[i].empty()) changes[i].points.push_back({rate, std::sqrt(squares / own)});
      before[i] = std::move(votes);
    }
  }
  return "<div>" + chart(label_of(preset, "change of the votes"), "sampling rate in detection", "", changes) +
         chart(label_of(preset, "seconds of detection"), "sampling rate in detection", "", {time}) + "</div>";
}

}  // namespace

std::string sampling(const Study& study) {
  std::string votes;
  for (const focal_preset preset : kPresets) votes += by_votes(study, preset);
  return by_rate(study) + by_shapes(study) +
         section(
             "Fig. 7 c: how much of the test shape is sampled",
             "The norm of the difference of two successive distributions of votes, over that of the later "
             "one. Both presets sample their share of what they analyse: preset default a proxy of 3,500 "
             "vertices.",
             "preset paper votes on the processor, so its time grows with the rate." +
                 std::string(study.quick ? " Forests of 10 trees in parts a and b." : ""),
             votes);
}

}  // namespace paper
