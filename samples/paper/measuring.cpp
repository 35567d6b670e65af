// Fig. 4, distances to choose from, and Fig. 5, regressed against true ones.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "chart.h"
#include "damage.h"
#include "page.h"
#include "study.h"

namespace paper {
namespace {

// The same marks on a coarser mesh: at its nearest vertices.
Marked coarser(const focal::Context& context, const Marked& marked, size_t vertices,
               const std::vector<std::string>& landmarks) {
  Marked result{marked.name, mesh_of(context, resampled(shape_of(marked.mesh), vertices)), {}};
  const uint64_t count = result.mesh.info().vertex_count;
  for (const std::string& name : landmarks) {
    if (!marked.marks.contains(name)) continue;
    const picture::Point p = place_of(marked, name);
    std::pair<double, uint32_t> best = {1e300, 0};
    for (uint32_t v = 0; v < count; ++v) {
      const float* at = result.mesh.positions() + 3 * size_t{v};
      best = std::min(best, {std::hypot(at[0] - p[0], at[1] - p[1], at[2] - p[2]), v});
    }
    result.marks[name] = result.mesh.point_at_vertex(best.second);
  }
  return result;
}

// Bands of even width: every other one is light.
picture::Figure banded(const Marked& marked, const std::vector<float>& distances,
                       const std::string& caption) {
  picture::Figure figure = surface_figure(marked.mesh);
  figure.triangles_drawn = 9000;
  const float largest = *std::max_element(distances.begin(), distances.end());
  for (const float d : distances) {
    const double share = d / largest;
    figure.heat.push_back(std::fmod(8 * share, 1.0) < 0.5 ? 1 - 0.8 * share : 0);
  }
  figure.caption = caption;
  return figure;
}

}  // namespace

std::string metrics(const Study& study) {
  const std::string landmark = study.main_landmark();
  const size_t vertices = std::min<size_t>(study.quick ? 1000 : 1500,  // exact distances take a while
                                           study.test().mesh.info().vertex_count);
  Set small{study.set.name, study.set.kinds, study.set.landmarks, study.set.mirror, {}, {}};
  for (size_t i = 0; i < std::min<size_t>(study.quick ? 3 : 5, study.set.train.size()); ++i)
    small.train.push_back(coarser(study.context, study.set.train[i], vertices, {landmark}));
  const Marked test = coarser(study.context, study.test(), vertices, {landmark});
  const Question question = question_about(test, landmark);
  std::vector<picture::Figure> figures(2 * focal_distance_count());
  picture::Figure seen = surface_figure(test.mesh);
  face(seen, question.truth);
  for (focal_distance d = 0; d < static_cast<int32_t>(focal_distance_count()); ++d) {
    const std::string name = focal_distance_name(d);
    figures[d] = banded(study.test(),
                        study.test().mesh.distances(study.context, d, study.test().marks.at(landmark)), name);
    const focal::Model model = learn(study.context, small, {.landmarks = {landmark}, .distance = d});
    picture::Figure& votes = figures[d + focal_distance_count()];
    votes = vote_figure(detect(model, test.mesh), test.mesh, question, name);
    figures[d].yaw = votes.yaw = seen.yaw, figures[d].pitch = votes.pitch = seen.pitch;
  }
  return section("Fig. 4: distances",
                 "From landmark " + landmark +
                     " in bands of even width, and what preset paper votes by each "
                     "distance. Bands of biharmonic and commute-time distance are uneven: a small error in "
                     "distance is a "
                     "long way on the surface.",
                 "votes on meshes of " + std::to_string(vertices) + " vertices, learned from " +
                     std::to_string(small.train.size()) +
                     " shapes, where exact distances take little time; preset default takes geodesic "
                     "distances only, since its terms are lengths.",
                 pictures(figures, focal_distance_count()));
}

std::string regression(const Study& study) {
  std::string charts;
  std::vector<std::vector<std::string>> rows = {{"landmark", "paper: mean square error", "default"}};
  std::vector<std::string> names = study.examples();
  for (const std::string& name : names) rows.push_back({name});
  for (const focal_preset preset : kPresets) {
    const focal::Model& model = study.model(preset);
    const focal::Analysis analysis = model.analyse(study.test().mesh);
    for (size_t i = 0; i < names.size(); ++i) {
      const auto told =
          model.regress(analysis, index_of(study.found(preset), names[i]), study.test().marks.at(names[i]));
      std::vector<size_t> order(told.truth.size());
      std::iota(order.begin(), order.end(), size_t{0});
      std::sort(order.begin(), order.end(),
                [&](size_t a, size_t b) { return told.truth[a] < told.truth[b]; });
      Curve truth{"true", "#d92626", {}}, regressed{"regressed", "#2563eb", {}, true};
      double square = 0;
      for (size_t k = 0; k < order.size(); ++k) {
        const auto at = static_cast<double>(k);
        truth.points.push_back({at, told.truth[order[k]]});
        regressed.points.push_back({at, told.regressed[order[k]]});
        square += std::pow(told.truth[k] - told.regressed[k], 2) / static_cast<double>(order.size());
      }
      charts += chart(label_of(preset, names[i]), "sample points in the order of distance", "distance",
                      {regressed, truth});
      rows[i + 1].push_back(fixed(square, 4));
    }
  }
  return section(
      "Fig. 5: regressed distances",
      "Distances of the sample points of the test shape as the forests regress them, and true distances.",
      "preset paper learns shares of each point's largest distance, preset default lengths over "
      "sqrt(area), so their numbers cannot be compared; the mean of its leaves is shown, but it votes "
      "with all they hold: far from a landmark with a mirror image they hold two distances.",
      charts + table(rows));
}

}  // namespace paper
