// What the figures of one set share: both models, what each finds on the first test shape, and how much may be done.
#pragma once
#include <array>
#include <memory>

#include "experiment.h"

namespace paper {

inline constexpr std::array<focal_preset, 2> kPresets = {FOCAL_PRESET_PAPER, FOCAL_PRESET_DEFAULT};

struct Study {
  const focal::Context& context;
  Set set;
  bool quick;
  StageSeconds training_seconds[2];                       // by preset
  std::vector<focal::Model> models;                       // by preset
  std::vector<std::vector<focal::Detection>> detections;  // by preset, then test shape

  Study(const focal::Context& running, Set given, bool is_quick);
  size_t place(focal_preset preset) const { return preset == FOCAL_PRESET_PAPER ? 0 : 1; }
  const focal::Model& model(focal_preset preset) const { return models[place(preset)]; }
  const focal::Detection& found(focal_preset preset) const { return detections[place(preset)][0]; }
  const Marked& test() const { return set.test[0]; }
  Question question(const std::string& landmark) const { return question_about(test(), landmark); }
  std::vector<std::string> examples() const { return set.kinds.examples(); }
  // A landmark that has a mirror image where there is one: the harder question.
  std::string main_landmark() const { return examples().front(); }
  // A quicker model that knows a few landmarks only.
  focal::Model small_model(Recipe recipe) const;
};

std::string label_of(focal_preset preset, const std::string& words);

// The sections, by the theme of their figures. Every one gives HTML.
std::string pipeline(const Study& study);                    // Figs. 1 and 6
std::string descriptors(const Study& study);                 // Fig. 2
std::string symmetry(const Study& study);                    // Fig. 3
std::string planes(const std::vector<Study>& studies);       // Fig. 3 b
std::string metrics(const Study& study);                     // Fig. 4
std::string regression(const Study& study);                  // Fig. 5
std::string sampling(const Study& study);                    // Fig. 7
std::string extraction(const Study& study);                  // Figs. 8 and 9
std::string few_marks(const Study& study);                   // beside Schelling points
std::string damage(const Study& study);                      // Fig. 10
std::string resolution(const Study& study);                  // Fig. 11
std::string applications(const Study& study);                // Figs. 12 and 13
std::string missing_parts(const Study& study);               // Fig. 14
std::string performance(const std::vector<Study>& studies);  // Table 1
std::string errors(const std::vector<Study>& studies);       // Table 2

}  // namespace paper
