// Game characters: from parts to a finished character.
#pragma once
#include <string>
#include <vector>

#include "character.h"
#include "parts.h"

namespace creatures::game {

struct Frame {
  std::string name;
  const Skeleton& skeleton;
  const Body& body;
  std::vector<Anchor> anchors;
  std::vector<Freedom> freedoms;
};

// Stands on the ground, has a size of its own, parts merged as some artist would have it, landmarks and a pose.
Character finish(const Frame& frame, std::vector<Part> parts, Random& random);

Character make_humanoid(const std::string& name, Random& random);
Character make_quadruped(const std::string& name, Random& random);

}  // namespace creatures::game
