// The ways in which a shape is spoiled, and what is asked of the detection afterwards.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "kit/corruption.h"
#include "shapes.h"

namespace focal_robustness {

struct Spoiled {
  focal::CorruptedMesh corrupted;
  focal::Matrix4 map = focal::Matrix4::Identity();  // from the clean mesh's space
  double scale = 1;                                 // of the map
};

struct Case {
  std::string name;
  std::string wanted;       // the figure to reach, as text
  bool missing = false;     // marks that are gone are to be told absent
  bool similarity = false;  // nothing but a map: the same answer is asked for
  std::function<Spoiled(const Shape&, focal::Random&)> spoil;
};

std::vector<Case> all_cases(const Shapes& shapes);

}  // namespace focal_robustness
