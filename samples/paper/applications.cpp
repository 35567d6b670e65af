// Figs. 12 and 13: segmentation that starts at the points found, correspondence, coarse skeletons.
#include <algorithm>
#include <map>
#include <random>

#include "page.h"
#include "study.h"

namespace paper {
namespace {

using Bones = std::vector<std::pair<std::string, std::string>>;

// A coarse skeleton over a set's points.
Bones bones_of(const std::string& set) {
  static const Bones human = {{"head_top", "navel"},
                              {"navel", "shoulder.L"},
                              {"navel", "shoulder.R"},
                              {"shoulder.L", "elbow_outer.L"},
                              {"shoulder.R", "elbow_outer.R"},
                              {"elbow_outer.L", "middle_finger.L"},
                              {"elbow_outer.R", "middle_finger.R"},
                              {"navel", "knee_front.L"},
                              {"navel", "knee_front.R"},
                              {"knee_front.L", "toe.L"},
                              {"knee_front.R", "toe.R"}};
  static const std::map<std::string, Bones> listed = {{"scape", human},
                                                      {"human07", human},
                                                      {"humanoid",
                                                       {{"crown", "chest"},
                                                        {"chest", "navel"},
                                                        {"chest", "shoulder.L"},
                                                        {"chest", "shoulder.R"},
                                                        {"shoulder.L", "elbow.L"},
                                                        {"shoulder.R", "elbow.R"},
                                                        {"elbow.L", "handTip.L"},
                                                        {"elbow.R", "handTip.R"},
                                                        {"navel", "knee.L"},
                                                        {"navel", "knee.R"},
                                                        {"knee.L", "toeTip.L"},
                                                        {"knee.R", "toeTip.R"}}},
                                                      {"quadruped",
                                                       {{"nose", "withers"},
                                                        {"withers", "belly"},
                                                        {"belly", "tailTip"},
                                                        {"withers", "elbow.L"},
                                                        {"withers", "elbow.R"},
                                                        {"elbow.L", "frontToe.L"},
                                                        {"elbow.R", "frontToe.R"},
                                                        {"belly", "hindToe.L"},
                                                        {"belly", "hindToe.R"}}},
                                                      {"lion",
                                                       {{"nose_top", "belly"},
                                                        {"belly", "tail_base_top"},
                                                        {"tail_base_top", "tail_tip"},
                                                        {"belly", "front_paw_outer.L"},
                                                        {"belly", "front_paw_outer.R"},
                                                        {"tail_base_top", "back_paw_outer.L"},
                                                        {"tail_base_top", "back_paw_outer.R"}}},
                                                      {"teddy",
                                                       {{"belly", "arm_tip.L"},
                                                        {"belly", "arm_tip.R"},
                                                        {"belly", "leg_tip.L"},
                                                        {"belly", "leg_tip.R"},
                                                        {"belly", "ear_tip.L"},
                                                        {"belly", "ear_tip.R"}}}};
  const auto found = listed.find(set);
  return found == listed.end() ? Bones{} : found->second;
}

picture::Figure parts_figure(const focal::Detection& detection, const Marked& shape,
                             const std::string& caption) {
  picture::Figure figure = surface_figure(shape.mesh);
  figure.triangles_drawn = 3500;
  figure.parts.assign(figure.positions.size(), 0);
  const std::vector<int32_t> labels = detection.segments(FOCAL_SEGMENTATION_K_MEANS);
  for (size_t t = 0; t < labels.size(); ++t)
    for (const uint32_t v : figure.triangles[t]) figure.parts[v] = std::max(labels[t], 0);
  figure.caption = caption;
  face_marks(figure, shape);
  return figure;
}

// The same model, its landmarks held at vertices drawn at random: k-means starts there.
focal::Detection from_anywhere(const Study& study, uint32_t seed) {
  std::mt19937 random(seed);
  const auto vertices = static_cast<uint32_t>(study.test().mesh.info().vertex_count);
  std::vector<focal_surface_point> points;
  for (size_t l = 0; l < study.set.landmarks.size(); ++l)
    points.push_back(study.test().mesh.point_at_vertex(static_cast<uint32_t>(random() % vertices)));
  auto params = focal::init(focal_detect_params_init);
  params.fixed_points = points.data();
  params.fixed_point_count = points.size();
  return study.model(FOCAL_PRESET_DEFAULT).detect(study.test().mesh, &params);
}

std::string segmentation(const Study& study) {
  std::vector<picture::Figure> figures;
  for (const focal_preset preset : kPresets)
    figures.push_back(parts_figure(study.found(preset), study.test(), label_of(preset, "from the points")));
  for (const uint32_t seed : {1u, 2u})
    figures.push_back(parts_figure(from_anywhere(study, seed), study.test(), "from anywhere"));
  return section(
      "Fig. 12: segmentation",
      "k-means of position and SI-HKS that starts at the points found, and at points drawn at random.", "",
      pictures(figures, figures.size()));
}

void add_bones(picture::Figure& figure, const Bones& bones) {
  const auto index = [&](const std::string& name) {
    return static_cast<size_t>(std::find_if(figure.marks.begin(), figure.marks.end(),
                                            [&](const picture::Mark& m) { return m.name == name; }) -
                               figure.marks.begin());
  };
  for (const auto& [a, b] : bones)
    if (index(a) < figure.marks.size() && index(b) < figure.marks.size())
      figure.bones.push_back({index(a), index(b)});
}

std::string correspondence(const Study& study) {
  std::vector<picture::Figure> figures;
  for (const focal_preset preset : kPresets)
    for (size_t shape = 0; shape < std::min<size_t>(3, study.set.test.size()); ++shape) {
      picture::Figure figure = surface_figure(study.set.test[shape].mesh);
      const focal::Detection& found = study.detections[study.place(preset)][shape];
      for (const focal_landmark& landmark : found.landmarks())
        figure.marks.push_back({landmark.name, found_place(found, landmark.name)});
      add_bones(figure, bones_of(study.set.name));
      figure.caption = label_of(preset, "shape " + std::to_string(shape + 1));
      face_marks(figure, study.set.test[shape]);
      figures.push_back(std::move(figure));
    }
  return section(
      "Fig. 13: correspondence and coarse skeletons",
      "Points of one colour correspond; lines are the skeleton that is defined once over the points.", "",
      pictures(figures, figures.size() / 2));
}

}  // namespace

std::string applications(const Study& study) { return segmentation(study) + correspondence(study); }

}  // namespace paper
