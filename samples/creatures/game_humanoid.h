// What the files of the game humanoids share: the plan of one character, its flesh, and who dresses it.
#pragma once
#include <string>
#include <vector>

#include "design.h"
#include "shop.h"
#include "stock_bones.h"

namespace creatures::game {

enum class Kind { realistic, stylised, chibi, mascot, robot, blocky };
enum class Hand { mitten, fist, fingers };

// Lengths for a body of 1.7, relative to an average adult where no unit is given.
struct Style {
  Kind kind;
  Make make;
  Hand hand;
  double head_share;   // of the height, from chin to crown
  double leg_share;    // of the height of the chin: up to the hip
  double ankle_share;  // of the height of the hip
  double width, depth, limbs, shoulders, hips, belly, bust, muscle;
  double arms, hands, feet, neck, stance;
  double head_width, head_depth, nose, eyes;
  double drop, bend;  // degrees: of the arms below the horizontal, of the elbows
  double snout;       // 0 without
  double square;      // of tubes
  int fingers, sides, vertices;
};

struct Places : HumanoidPlaces {
  Vec3 arm, forearm;  // directions
  Vec3 thumb, palm;   // directions at the hand: where the thumb is, where the palm looks
  double width, reach, sole;
  Vec3 skull, skull_radii;  // the ball that hats and hair sit on
};

using Bones = HumanoidBones;

struct Plan {
  Style style;
  Places at;
  Bones bones;
};

Plan plan_humanoid(Random& random);
std::vector<Anchor> anchors(const Plan& plan);
std::vector<Freedom> freedoms(const Plan& plan);

// Of the left side and the middle; `paired` ones stand for both sides.
struct Flesh {
  std::vector<Sweep> torso, head, arms, hands, legs, feet;
  std::vector<Sweep> all() const;
};
Flesh flesh_of(const Plan& plan);

// Everything that makers of parts need, and what they have made.
struct Workshop : Shop {
  const Plan& plan;
  const Flesh& flesh;
  std::vector<int> covered = {};  // bones that are under clothes all along
};

void make_flesh(Workshop& shop);
// Flesh under clothes is taken away or lies a little deeper; `flesh_parts`: the first so many parts.
void hide_flesh(Workshop& shop, size_t flesh_parts);
void make_robot(Workshop& shop);
void dress(Workshop& shop);           // clothes
void make_head_gear(Workshop& shop);  // eyes, teeth, hair, ears, hats
void equip(Workshop& shop);           // armour, packs, capes, tails, weapons

}  // namespace creatures::game
