// Fig. 1, the way from marked shapes to a found point, and Fig. 6, how votes add up.
#include <algorithm>

#include "page.h"
#include "study.h"

namespace paper {
namespace {

// 1 at the point, 0 at the far end.
void paint_nearness(picture::Figure& figure, const std::vector<float>& distances) {
  const float largest = *std::max_element(distances.begin(), distances.end());
  for (const float d : distances) figure.heat.push_back(1 - d / largest);
}

picture::Figure marked_figure(const Marked& marked, const std::string& landmark, const std::string& caption) {
  picture::Figure figure = surface_figure(marked.mesh);
  figure.marks = {{landmark, place_of(marked, landmark), false, "#d92626"}};
  figure.caption = caption;
  face(figure, figure.marks[0].position);
  return figure;
}

std::string votes_as_samples_grow(const Study& study) {
  std::vector<picture::Figure> figures;
  const std::vector<int32_t> counts = {3, 10, 30, 100, 1250};
  const Question question = study.question(study.main_landmark());
  picture::Figure seen = surface_figure(study.test().mesh);
  face(seen, question.truth);
  for (const focal_preset preset : kPresets)
    for (const int32_t count : counts) {
      figures.push_back(vote_figure(detect(study.model(preset), study.test().mesh, count), study.test().mesh,
                                    question, label_of(preset, std::to_string(count))));
      figures.back().yaw = seen.yaw, figures.back().pitch = seen.pitch;
    }
  return section(
      "Fig. 6: votes add up",
      "Landmark " + question.landmark +
          ": 3, 10, 30, 100 and 1250 points of the surface vote, each "
          "along the circle at the distance that its descriptor tells.",
      "preset default votes with the whole distribution of distances that the leaves hold, so a few "
      "points leave wide bands instead of thin circles.",
      pictures(figures, counts.size()));
}

}  // namespace

std::string pipeline(const Study& study) {
  const std::string landmark = study.examples().back();
  std::vector<picture::Figure> figures;
  for (size_t i = 0; i < std::min<size_t>(2, study.set.train.size()); ++i)
    figures.push_back(marked_figure(study.set.train[i], landmark, "marked"));
  const Marked& first = study.set.train[0];
  figures.push_back(marked_figure(first, landmark, "distances learned"));
  paint_nearness(figures.back(),
                 first.mesh.distances(study.context, FOCAL_DISTANCE_HEAT, first.marks.at(landmark)));
  const Question question = study.question(landmark);
  for (const focal_preset preset : kPresets) {
    figures.push_back(
        vote_figure(study.found(preset), study.test().mesh, question, label_of(preset, "votes")));
    face(figures.back(), question.truth);
  }
  return section("Fig. 1: from marks to a found point",
                 "Landmark " + landmark +
                     " is marked on the training shapes; the distances to it are learned; the "
                     "points of a new shape vote for where it is.",
                 "", pictures(figures, figures.size())) +
         votes_as_samples_grow(study);
}

}  // namespace paper
