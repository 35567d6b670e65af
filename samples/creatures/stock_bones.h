// Joints and bones that the plain and the game families of one kind have in common.
#pragma once
#include <vector>

#include "design.h"
#include "skeleton.h"

namespace creatures {

struct HumanoidPlaces {
  Vec3 hips, spine, chest, upper_chest, neck, head, crown;
  Vec3 clavicle, shoulder, elbow, wrist, fingertip;
  Vec3 hip, knee, ankle, toes, toe_tip;
};

struct HumanoidBones {
  Skeleton all;
  int hips, spine, chest, upper_chest, neck, head, shoulder, upper_arm, lower_arm, hand, upper_leg, lower_leg,
      foot, toes;
};

HumanoidBones humanoid_skeleton(const HumanoidPlaces& places);
// Those of the trunk and the limbs, between the ones that a head, a hand and a foot of its own kind have.
std::vector<Anchor> humanoid_anchors(const HumanoidPlaces& places, std::vector<Anchor> head,
                                     const std::vector<Anchor>& hand, const std::vector<Anchor>& foot);

struct QuadrupedPlaces {
  Vec3 hips, spine, chest, neck, head, nose;
  Vec3 tail[4];
  Vec3 shoulder, elbow, wrist, front_paw, front_toe;
  Vec3 hip, knee, hock, hind_paw, hind_toe;
  Vec3 ear, ear_tip;
};

struct QuadrupedBones {
  Skeleton all;
  int hips, spine, chest, neck, head, tail[3], ear;
  int front_upper, front_lower, front_foot, front_paw;
  int hind_upper, hind_lower, hind_foot, hind_paw;
};

QuadrupedBones quadruped_skeleton(const QuadrupedPlaces& places);

}  // namespace creatures
