// What makes one individual: skeleton, flesh, landmark anchors and joint limits.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "body.h"
#include "random.h"
#include "skeleton.h"

namespace creatures {

// The landmark is where a ray from inside the body at rest leaves it. `paired`: name + ".L" and, mirrored, ".R".
struct Anchor {
  std::string name;
  Vec3 inside, direction;
  bool paired = false;
};

struct Design {
  Skeleton skeleton;
  Body body;
  std::vector<Anchor> anchors;
  std::vector<Freedom> freedoms;
  double lattice_cell;  // finer than the smallest detail
  double scale = 1;     // of the finished character
};

Design design_humanoid(Random& random);
Design design_quadruped(Random& random);
Design design_hand(Random& random);
Design design_insect(Random& random);

// Waves of at most about `size`, for Body.
std::array<double, 6> random_asymmetry(Random& random, double size);

struct Character;
struct Family {
  std::string_view name, description;
  Design (*design)(Random& random);                                      // of one closed surface
  Character (*make)(const std::string& name, Random& random) = nullptr;  // of parts, instead of `design`
};
const std::vector<Family>& families();
// Characters as games have them: of parts that may be open, overlap or hide each other.
const std::vector<Family>& game_families();

}  // namespace creatures
