#include "stock_bones.h"

#include <string>
#include <utility>

namespace creatures {

HumanoidBones humanoid_skeleton(const HumanoidPlaces& p) {
  HumanoidBones b;
  Skeleton& s = b.all;
  b.hips = s.add("hips", -1, p.hips, p.spine);
  b.spine = s.add("spine", b.hips, p.spine, p.chest);
  b.chest = s.add("chest", b.spine, p.chest, p.upper_chest);
  b.upper_chest = s.add("upperChest", b.chest, p.upper_chest, p.neck);
  b.neck = s.add("neck", b.upper_chest, p.neck, p.head);
  b.head = s.add("head", b.neck, p.head, p.crown);
  b.shoulder = s.add_pair("Shoulder", b.upper_chest, p.clavicle, p.shoulder);
  b.upper_arm = s.add_pair("UpperArm", b.shoulder, p.shoulder, p.elbow);
  b.lower_arm = s.add_pair("LowerArm", b.upper_arm, p.elbow, p.wrist);
  b.hand = s.add_pair("Hand", b.lower_arm, p.wrist, p.fingertip);
  b.upper_leg = s.add_pair("UpperLeg", b.hips, p.hip, p.knee);
  b.lower_leg = s.add_pair("LowerLeg", b.upper_leg, p.knee, p.ankle);
  b.foot = s.add_pair("Foot", b.lower_leg, p.ankle, p.toes);
  b.toes = s.add_pair("Toes", b.foot, p.toes, p.toe_tip);
  return b;
}

std::vector<Anchor> humanoid_anchors(const HumanoidPlaces& p, std::vector<Anchor> head,
                                     const std::vector<Anchor>& hand, const std::vector<Anchor>& foot) {
  const Vec3 front = Vec3::UnitZ(), back = -front, left = Vec3::UnitX(), down = -Vec3::UnitY();
  std::vector<Anchor> all = std::move(head);
  const auto add = [&](const std::vector<Anchor>& more) { all.insert(all.end(), more.begin(), more.end()); };
  add({{"chest", p.upper_chest - Vec3(0, 0.02, 0), front},
       {"navel", p.spine, front},
       {"upperBack", p.upper_chest + Vec3(0, 0.03, 0), back},
       {"lowerBack", p.spine - Vec3(0, 0.01, 0), back},
       {"crotch", p.hips, down},
       {"shoulder", p.shoulder, left + 0.6 * Vec3::UnitY(), true},
       {"elbow", p.elbow, back, true}});
  add(hand);
  add({{"hip", p.hip + Vec3(0, 0.01, 0), left, true}, {"knee", p.knee, front, true}});
  add(foot);
  return all;
}

QuadrupedBones quadruped_skeleton(const QuadrupedPlaces& p) {
  QuadrupedBones b;
  Skeleton& s = b.all;
  b.hips = s.add("hips", -1, p.hips, p.spine);
  b.spine = s.add("spine", b.hips, p.spine, p.chest);
  b.chest = s.add("chest", b.spine, p.chest, p.neck);
  b.neck = s.add("neck", b.chest, p.neck, p.head);
  b.head = s.add("head", b.neck, p.head, p.nose);
  for (int i = 0; i < 3; ++i)
    b.tail[i] =
        s.add("tail" + std::to_string(i + 1), i == 0 ? b.hips : b.tail[i - 1], p.tail[i], p.tail[i + 1]);
  b.ear = s.add_pair("Ear", b.head, p.ear, p.ear_tip);
  b.front_upper = s.add_pair("FrontUpperLeg", b.chest, p.shoulder, p.elbow);
  b.front_lower = s.add_pair("FrontLowerLeg", b.front_upper, p.elbow, p.wrist);
  b.front_foot = s.add_pair("FrontFoot", b.front_lower, p.wrist, p.front_paw);
  b.front_paw = s.add_pair("FrontPaw", b.front_foot, p.front_paw, p.front_toe);
  b.hind_upper = s.add_pair("HindUpperLeg", b.hips, p.hip, p.knee);
  b.hind_lower = s.add_pair("HindLowerLeg", b.hind_upper, p.knee, p.hock);
  b.hind_foot = s.add_pair("HindFoot", b.hind_lower, p.hock, p.hind_paw);
  b.hind_paw = s.add_pair("HindPaw", b.hind_foot, p.hind_paw, p.hind_toe);
  return b;
}

}  // namespace creatures
