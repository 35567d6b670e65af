// What the files of the game quadrupeds share: the plan of one animal and its flesh.
#pragma once
#include <vector>

#include "design.h"
#include "shop.h"
#include "stock_bones.h"

namespace creatures::game::beast {

enum class Species { dog, cat, horse, cow, deer, pig, elephant, bear, lizard, any };

// Lengths in metres for an animal with a trunk of 0.66 between hips and neck; shares where no unit is given.
struct Style {
  Species species = Species::any;
  Make make = Make::skin;
  bool blocky = false, hooves = false;
  double height = 0.56;  // of hips and shoulders
  double barrel = 1.1, chest = 1, waist = 0.85, limbs = 1, paws = 1;
  double crouch = 1;  // 1: knees and hocks bend like a dog's, 0: columns
  double sprawl = 0;  // sideways to the elbows
  double neck = 0.26, neck_up = 48, head = 1, head_wide = 1, muzzle = 1, muzzle_thick = 1,
         nod = 15;  // degrees
  double ears = 1, ear_up = 70, ear_wide = 1;
  double tail = 0.45, tail_up = -10, tail_thick = 1;
  double horns = 0, trunk = 0, mane = 0, hump = 0;
  double square = 0;
  int sides = 8, vertices = 1000;
};

struct Places : QuadrupedPlaces {
  Vec3 along;  // from head to nose
};
using Bones = QuadrupedBones;

struct Plan {
  Style style;
  Places at;
  Bones bones;
};

Plan plan_quadruped(Random& random);
std::vector<Anchor> anchors(const Plan& plan);
std::vector<Freedom> freedoms(const Plan& plan);

struct Flesh {
  std::vector<Sweep> trunk, head, legs, tail, ears;
  std::vector<Sweep> all() const { return joined({&trunk, &legs, &tail, &head, &ears}); }
};
Flesh flesh_of(const Plan& plan);

}  // namespace creatures::game::beast
