// The range of game humanoids: style, places of the 22 joints, skeleton.
#include <algorithm>
#include <cmath>

#include "game_humanoid.h"

namespace creatures::game {
namespace {

constexpr double height = 1.7, degree = EIGEN_PI / 180;

Kind random_kind(Random& random) {
  const double u = random.uniform(0, 1);
  if (u < 0.34) return Kind::realistic;
  if (u < 0.54) return Kind::stylised;
  if (u < 0.75) return Kind::chibi;
  if (u < 0.85) return Kind::mascot;
  return u < 0.94 ? Kind::robot : Kind::blocky;
}

double random_head_share(Kind kind, Random& random) {
  switch (kind) {
    case Kind::realistic:
      return random.uniform(0.122, 0.15);
    case Kind::stylised:
      return random.uniform(0.15, 0.26);
    case Kind::chibi:
      return random.uniform(0.27, 0.5);
    case Kind::mascot:
      return random.uniform(0.18, 0.42);
    default:
      return random.uniform(0.11, 0.32);
  }
}

void shape_body(Style& s, Random& random) {
  const double cute = std::clamp((s.head_share - 0.13) / 0.3, 0.0, 1.0);
  const double stout = std::pow(random.uniform(-1, 1), 3);  // seldom thin or fat
  const bool monster = s.kind == Kind::mascot;
  s.leg_share = 0.635 - 0.2 * cute + random.typical(-0.05, 0.06) - (monster ? random.uniform(0, 0.12) : 0);
  const bool built = s.kind == Kind::robot || s.kind == Kind::blocky;
  const double wide = monster || built ? random.uniform(1, 1.35) : 1 + 0.35 * cute * random.uniform(0, 1);
  s.width = random.uniform(0.9, 1.08) * (1 + 0.3 * stout) * wide;
  s.depth = random.uniform(0.92, 1.1) * (1 + 0.2 * stout);
  s.limbs = random.uniform(0.8, 1.1) * (1 + 0.25 * stout) *
            (built ? random.uniform(0.9, 1.6) : 1 + 0.55 * cute * random.uniform(-0.3, 1));
  s.limbs = std::max(s.limbs, 0.78);
  s.shoulders = random.uniform(0.84, 1.16) - 0.08 * cute;
  s.hips = random.uniform(0.9, 1.12);
  s.muscle = random.uniform(0, 1.3);
  s.belly = random.typical(-0.4, 0.5) + 1.1 * std::max(stout, 0.0) + (monster ? random.uniform(0, 1.5) : 0);
  s.bust = random.uniform(-0.8, 1) * (1 - cute);
  s.arms = random.typical(0.84, 1.16) * (monster ? random.uniform(0.9, 1.5) : 1) +
           (random.uniform(0, 1) < 0.07 ? 0.25 : 0);
  s.hands = random.typical(0.9, 1.15) + 0.6 * cute * random.uniform(0, 1) + (monster ? 0.25 : 0);
  s.feet = random.typical(0.9, 1.15) + 0.35 * cute * random.uniform(-0.4, 1) + (monster ? 0.2 : 0);
  s.ankle_share = random.typical(0.078, 0.125) + 0.17 * cute * random.uniform(0.2, 1);
  s.neck = random.uniform(0.7, 1.25) * (1 - 0.75 * cute);
  s.stance = random.uniform(-0.012, 0.035);
}

void shape_head(Style& s, Random& random) {
  const double cute = std::clamp((s.head_share - 0.15) / 0.2, 0.0, 1.0);
  s.head_width = random.uniform(0.9, 1.08) + cute * random.uniform(0, 0.45);
  s.head_depth = random.uniform(0.92, 1.06) + cute * random.uniform(-0.1, 0.2);
  s.nose = random.uniform(0.5, 1.2) * (1 - 0.6 * cute);
  s.eyes = random.uniform(0.85, 1.2) + 0.7 * cute;
  s.snout = s.kind == Kind::mascot && random.uniform(0, 1) < 0.6 ? random.uniform(0.5, 1.4) : 0;
}

Style random_style(Random& random) {
  Style s{};
  s.kind = random_kind(random);
  s.head_share = random_head_share(s.kind, random);
  shape_body(s, random);
  shape_head(s, random);
  const double pose = random.uniform(0, 1);  // T, A or hanging
  s.drop = pose < 0.45   ? random.uniform(-2, 6)
           : pose < 0.85 ? random.uniform(25, 58)
                         : random.uniform(58, 76);
  s.bend = random.uniform(0, 1) < 0.5 ? random.uniform(0, 6) : random.uniform(4, 26);
  const double make = random.uniform(0, 1);
  s.make = make < 0.5 ? Make::skin : make < 0.72 ? Make::pieces : Make::tubes;
  if (s.kind == Kind::robot || s.kind == Kind::blocky) s.make = Make::tubes;
  const double hand = random.uniform(0, 1), small = s.head_share > 0.26 ? 1 : 0;
  s.hand = hand < 0.3 + 0.3 * small ? Hand::mitten : hand < 0.4 + 0.4 * small ? Hand::fist : Hand::fingers;
  s.fingers = small || random.uniform(0, 1) < 0.25 ? 3 : 4;
  const double wealth = random.uniform(0, 1);  // from low poly to rich
  s.sides = static_cast<int>(5 + 13 * wealth * wealth + random.uniform(0, 2));
  s.vertices = static_cast<int>(260 * std::exp(2.35 * wealth));
  s.square = s.kind == Kind::blocky ? 1 : random.uniform(0, 1) < 0.3 ? random.uniform(0.1, 0.55) : 0;
  if (s.kind == Kind::blocky) s.sides = 4;
  return s;
}

void place_arm(Places& p, const Style& s, double torso, double tall) {
  const double w = p.width, reach = p.reach;
  p.clavicle = {0.042 * w, p.neck.y() - 0.055 * torso, 0};
  p.shoulder = {0.168 * w * s.shoulders, p.neck.y() - 0.068 * torso, -0.018};
  p.arm = Vec3(std::cos(s.drop * degree), -std::sin(s.drop * degree), 0);
  const Vec3 flex = p.arm.cross(Vec3::UnitZ());
  p.forearm = Eigen::AngleAxisd(s.bend * degree, flex) * p.arm;
  p.elbow = p.shoulder + 0.275 * reach * p.arm;
  p.wrist = p.elbow + 0.255 * reach * p.forearm;
  p.fingertip = p.wrist + 0.18 * s.hands * tall * p.forearm;
  p.thumb = Eigen::AngleAxisd(s.bend * degree, flex) * Vec3::UnitZ();
  p.palm = p.forearm.cross(p.thumb).normalized();
  if (p.palm.y() > 0) p.palm = -p.palm;
}

void place_leg(Places& p, const Style& s, double hip_height, double tall) {
  const double w = p.width, ankle = s.ankle_share * hip_height;
  const double limb = 0.082 * w * s.limbs;  // thick legs stand apart
  p.hip = {std::max(0.09 * w * s.hips, 0.8 * limb), hip_height, -0.005};
  p.knee = p.hip + Vec3(0.012 + 0.5 * s.stance, -0.505 * (hip_height - ankle), 0.008);
  p.ankle = {p.hip.x() + 0.018 + s.stance, ankle, -0.02};
  const double f = s.feet * tall;
  p.toes = p.ankle + Vec3(0.013, -0.65 * ankle, 0.12 * f);
  p.toe_tip = p.toes + Vec3(0.008, -0.005, 0.075 * f);
  p.sole = ankle;
}

Places place(const Style& s) {
  Places p;
  const double head = s.head_share * height, chin = height - head, body = chin / 1.46;
  const double hip_height = s.leg_share * chin, tall = std::pow(body, 0.35);
  const double neck = std::max(0.085 * body * s.neck, 0.035);
  const double torso = (chin + 0.03 - neck - hip_height) / 0.52;
  p.width = s.width * std::pow(body, 0.25);
  p.reach = s.arms * std::sqrt(body * (0.3 + 0.7 * torso));
  const double y = hip_height, t = torso;
  p.hips = {0, y + 0.04 * t, -0.005};
  p.spine = {0, y + 0.12 * t, -0.01};
  p.chest = {0, y + 0.24 * t, -0.015};
  p.upper_chest = {0, y + 0.37 * t, -0.02};
  p.neck = {0, y + 0.52 * t, -0.025};
  p.head = p.neck + Vec3(0, neck, 0.015);
  p.crown = {0, height, p.head.z() - 0.005};
  const double h = head / 0.244;
  p.skull = {0, chin + 0.148 * h, p.head.z() + 0.002 * h};
  p.skull_radii = h * Vec3(0.078 * s.head_width, 0.096, 0.094 * s.head_depth);
  place_arm(p, s, torso, tall);
  place_leg(p, s, hip_height, tall);
  return p;
}

}  // namespace

Plan plan_humanoid(Random& random) {
  const Style style = random_style(random);
  const Places at = place(style);
  return {style, at, humanoid_skeleton(at)};
}

std::vector<Anchor> anchors(const Plan& plan) {
  const Places& p = plan.at;
  const Vec3 front = Vec3::UnitZ(), back = -front, down = -Vec3::UnitY();
  const Vec3 low = p.skull - Vec3(0, 0.55 * p.skull_radii.y(), 0);
  const Vec3 hand = p.wrist + 0.25 * (p.fingertip - p.wrist);
  return humanoid_anchors(
      p,
      {{"crown", p.skull, Vec3::UnitY()},
       {"nose", low + Vec3(0, 0.15 * p.skull_radii.y(), 0), front},
       {"chin", low, front + 1.2 * down}},
      {{"handTip", hand, p.forearm, true}, {"thumbTip", hand, p.forearm + 1.5 * p.thumb, true}},
      {{"heel", p.ankle - Vec3(0, 0.5 * p.sole, 0), back, true},
       {"toeTip", p.toes, p.toe_tip - p.toes + 0.003 * Vec3::UnitY(), true}});
}

std::vector<Freedom> freedoms(const Plan& plan) {
  const Bones& b = plan.bones;
  const Places& p = plan.at;
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ(), flex = p.arm.cross(z);
  return {{b.spine, x, -8, 18},
          {b.spine, y, -10, 10},
          {b.chest, x, -5, 12},
          {b.chest, y, -12, 12},
          {b.neck, x, -10, 15},
          {b.head, y, -30, 30},
          {b.head, z, -10, 10},
          {b.lower_arm, flex, 0, 80, true},
          {b.hand, flex, -15, 35, true},
          {b.upper_arm, p.arm, -30, 30, true},
          {b.upper_arm, y, -50, 20, true},
          {b.upper_arm, z, -15, 40, true},
          {b.shoulder, z, -4, 12, true},
          {b.lower_leg, x, 0, 60, true},
          {b.foot, x, -15, 20, true},
          {b.upper_leg, z, -2, 20, true},
          {b.upper_leg, x, -50, 20, true}};
}

}  // namespace creatures::game
