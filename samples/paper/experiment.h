// A set of marked meshes, models of it, and one detection as a figure: votes, where it is marked, where it was found.
#pragma once
#include <focal/focal.hpp>
#include <map>
#include <string>
#include <vector>

#include "kinds.h"
#include "picture/drawing.h"

namespace paper {

struct Marked {
  std::string name;
  focal::Mesh mesh;
  std::map<std::string, focal_surface_point> marks;
};

struct Set {
  std::string name;
  Kinds kinds;
  std::vector<std::string> landmarks;         // those of the three kinds
  std::map<std::string, std::string> mirror;  // as set.json has it
  std::vector<Marked> train;
  std::vector<Marked> test;
};

// At most so many meshes of each split.
Set load_set(const focal::Context& context, const std::string& folder, size_t train, size_t test);

// How a model is learned; 0: as the preset has it.
struct Recipe {
  focal_preset preset = FOCAL_PRESET_PAPER;
  size_t meshes = SIZE_MAX;
  std::vector<std::string> landmarks = {};  // empty: all of the set
  focal_descriptor descriptor = FOCAL_DESCRIPTOR_SI_HKS;
  focal_distance distance = FOCAL_DISTANCE_HEAT;
  double sampling_rate = 0;
  int32_t trees = 0;
};

using StageSeconds = std::map<std::string, double>;  // by focal_task_stage

// seconds: how long each stage took, to some milliseconds.
focal::Model learn(const focal::Context& context, const Set& set, const Recipe& recipe,
                   StageSeconds* seconds = nullptr);

struct Question {
  std::string landmark;
  picture::Point truth;  // where it is marked
  double edge = 1;       // unit of the errors
};

picture::Point place_of(const Marked& marked, const std::string& landmark);
Question question_about(const Marked& marked, const std::string& landmark);

// With so many sample points that vote; 0: as by default.
focal::Detection detect(const focal::Model& model, const focal::Mesh& mesh, int32_t samples = 0);

uint32_t index_of(const focal::Detection& detection, const std::string& landmark);
picture::Point found_place(const focal::Detection& detection, const std::string& landmark);
double error_of(const focal::Detection& detection, const Question& question);

picture::Figure surface_figure(const focal::Mesh& mesh);
// Turns it so that most of the surface round a point is seen.
void face(picture::Figure& figure, const picture::Point& point);
// Turns it so that most of the marks are seen.
void face_marks(picture::Figure& figure, const Marked& marked);

// The caption is `label` and the error.
picture::Figure vote_figure(const focal::Detection& detection, const focal::Mesh& mesh,
                            const Question& question, const std::string& label);

// All landmarks at once as in the paper's Fig. 9: votes squared, those below 0.2 left out; the caption has the mean error.
picture::Figure all_votes_figure(const focal::Detection& detection, const Marked& marked,
                                 const std::string& label);

}  // namespace paper
