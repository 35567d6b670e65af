#include "study.h"

namespace paper {

Study::Study(const focal::Context& running, Set given, bool is_quick)
    : context(running), set(std::move(given)), quick(is_quick) {
  for (const focal_preset preset : kPresets) {
    models.push_back(learn(context, set, {.preset = preset}, &training_seconds[place(preset)]));
    detections.emplace_back();
    for (const Marked& shape : set.test) detections.back().push_back(detect(models.back(), shape.mesh));
  }
}

focal::Model Study::small_model(Recipe recipe) const {
  if (recipe.landmarks.empty()) recipe.landmarks = examples();
  if (recipe.trees == 0 && quick) recipe.trees = 10;
  return learn(context, set, recipe);
}

std::string label_of(focal_preset preset, const std::string& words) {
  return std::string(preset == FOCAL_PRESET_PAPER ? "paper" : "default") + ", " + words;
}

}  // namespace paper
