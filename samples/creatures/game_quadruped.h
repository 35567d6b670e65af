// What the files of the game quadrupeds share: the plan of one animal and its flesh.
#pragma once
#include <vector>

#include "design.h"
#include "shop.h"

namespace creatures::game::beast {

enum class Species { dog, cat, horse, cow, deer, pig, elephant, bear, lizard, any, count };

// Lengths in metres for an animal with a trunk of 0.66 between hips and neck; shares where no unit is given.
struct Style {
  Species species;
  Make make;
  bool blocky, hooves;
  double height, barrel, chest, waist, limbs, paws;  // height: of hips and shoulders
  double crouch;                                     // 1: knees and hocks bend like a dog's, 0: columns
  double sprawl;                                     // sideways to the elbows
  double neck, neck_up, head, head_wide, muzzle, muzzle_thick, nod;  // angles in degrees
  double ears, ear_up, ear_wide;
  double tail, tail_up, tail_thick;
  double horns, trunk, mane, hump;
  double square;
  int sides, vertices;
};

struct Places {
  Vec3 hips, spine, chest, neck, head, nose;
  Vec3 tail[4];
  Vec3 shoulder, elbow, wrist, front_paw, front_toe;
  Vec3 hip, knee, hock, hind_paw, hind_toe;
  Vec3 ear, ear_tip, along;  // along: from head to nose
};

struct Bones {
  Skeleton all;
  int hips, spine, chest, neck, head, tail[3], ear;
  int front_upper, front_lower, front_foot, front_paw;
  int hind_upper, hind_lower, hind_foot, hind_paw;
};

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
