// A set of marked meshes, models of it, and one detection as a figure: votes, where it is marked, where it was found.
#pragma once
#include <focal/focal.hpp>
#include <map>
#include <string>
#include <vector>

#include "picture/drawing.h"

namespace paper {

struct Marked {
  std::string name;
  focal::Mesh mesh;
  std::map<std::string, focal_surface_point> marks;
};

struct Set {
  std::string name;
  std::vector<std::string> landmarks;
  std::map<std::string, std::string> mirror;  // as set.json has it
  std::vector<Marked> train;
  std::vector<Marked> test;
};

// At most so many meshes of each split.
Set load_set(const focal::Context& context, const std::string& folder, size_t train, size_t test);

focal::Model learn(const focal::Context& context, const Set& set, size_t meshes, focal_preset preset);

struct Question {
  std::string landmark;
  picture::Point truth;  // where it is marked
  double edge = 1;       // errors are told in this length
};

picture::Point place_of(const Marked& marked, const std::string& landmark);

// With so many sample points that vote; 0: as by default.
focal::Detection detect(const focal::Model& model, const focal::Mesh& mesh, int32_t samples = 0);

// The caption is `label` and the error. All figures of one landmark and shape are seen from one side.
picture::Figure vote_figure(const focal::Detection& detection, const focal::Mesh& mesh,
                            const Question& question, const std::string& label);

}  // namespace paper
