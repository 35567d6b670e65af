// The range of game quadrupeds: style, places of the joints, skeleton.
#include <algorithm>
#include <cmath>

#include "game_quadruped.h"

namespace creatures::game::beast {
namespace {

constexpr double degree = EIGEN_PI / 180;

// What is usual for a species; individuals vary around it.
Style usual(Species species) {
  Style s{};
  s.species = species;
  s.height = 0.56, s.barrel = 1.1, s.chest = 1, s.waist = 0.85, s.limbs = 1, s.paws = 1, s.crouch = 1;
  s.neck = 0.26, s.neck_up = 48, s.head = 1, s.head_wide = 1, s.muzzle = 1, s.muzzle_thick = 1, s.nod = 15;
  s.ears = 1, s.ear_up = 70, s.ear_wide = 1, s.tail = 0.45, s.tail_up = -10, s.tail_thick = 1;
  switch (species) {
    case Species::cat:
      s.height = 0.48, s.barrel = 0.9, s.neck = 0.2, s.muzzle = 0.35, s.head_wide = 1.2, s.tail = 0.6,
      s.ears = 0.8;
      break;
    case Species::horse:
      s.height = 0.72, s.barrel = 1.5, s.neck = 0.42, s.neck_up = 52, s.head = 1.15, s.muzzle = 1.5,
      s.nod = 45;
      s.ears = 0.7, s.hooves = true, s.crouch = 0.75, s.tail_up = -65, s.mane = 0.6, s.head_wide = 0.85;
      break;
    case Species::cow:
      s.height = 0.58, s.barrel = 1.75, s.waist = 1, s.neck = 0.27, s.neck_up = 25, s.head = 1.2,
      s.muzzle = 1.3, s.nod = 35;
      s.ears = 0.8, s.ear_up = 0, s.hooves = true, s.crouch = 0.6, s.tail_up = -75, s.horns = 0.6,
      s.muzzle_thick = 1.3;
      break;
    case Species::deer:
      s.height = 0.74, s.barrel = 1.15, s.limbs = 0.75, s.neck = 0.38, s.neck_up = 60, s.muzzle = 1.2,
      s.nod = 25;
      s.ears = 1.1, s.ear_up = 45, s.hooves = true, s.tail = 0.13, s.horns = 0.7, s.head = 0.9;
      break;
    case Species::pig:
      s.height = 0.4, s.barrel = 1.65, s.waist = 1.05, s.neck = 0.2, s.neck_up = 8, s.head = 1.25,
      s.muzzle = 1, s.muzzle_thick = 1.4;
      s.ears = 0.9, s.hooves = true, s.crouch = 0.5, s.tail = 0.16, s.tail_thick = 0.6, s.limbs = 1.05;
      break;
    case Species::elephant:
      s.height = 0.66, s.barrel = 2.1, s.waist = 1, s.limbs = 2, s.paws = 1.3, s.neck = 0.26, s.neck_up = 25,
      s.head = 1.9;
      s.muzzle = 0.5, s.ears = 1.35, s.ear_up = -30, s.ear_wide = 2, s.crouch = 0.1, s.trunk = 1,
      s.tail_up = -75, s.tail_thick = 0.6;
      break;
    case Species::bear:
      s.height = 0.52, s.barrel = 1.65, s.waist = 1.05, s.limbs = 1.6, s.paws = 1.5, s.neck = 0.22,
      s.neck_up = 22, s.head = 1.3;
      s.muzzle = 0.8, s.ears = 0.6, s.ear_wide = 1.4, s.tail = 0.1, s.crouch = 0.5, s.hump = 0.4,
      s.head_wide = 1.15;
      break;
    case Species::lizard:
      s.height = 0.26, s.barrel = 0.85, s.waist = 1.05, s.neck = 0.2, s.neck_up = 12, s.head = 1,
      s.muzzle = 1.4, s.nod = 5;
      s.ears = 0.25, s.tail = 0.95, s.tail_up = -12, s.tail_thick = 2.6, s.sprawl = 0.15, s.crouch = 0.6,
      s.paws = 1.1;
      break;
    default:
      break;
  }
  return s;
}

void vary_trunk(Style& s, Random& random) {
  const bool wild = s.species == Species::any;  // nobody knows what it is
  const auto about = [&](double spread) {
    return wild ? random.uniform(0.65, 1.6) : random.typical(1 - spread, 1 + spread);
  };
  const double stout = std::pow(random.uniform(-1, 1), 3);
  s.height *= about(0.18);
  s.barrel = std::clamp(s.barrel * about(0.15) * (1 + 0.3 * stout), 0.6, 4.2 * s.height);
  s.chest *= random.typical(0.88, 1.15);
  s.waist *= random.typical(0.85, 1.2);
  s.limbs = std::max(0.65, s.limbs * about(0.2) * (1 + 0.25 * stout));
  s.paws *= random.uniform(0.85, 1.3);
  s.crouch = std::clamp(s.crouch + random.uniform(-0.3, 0.2), 0.0, 1.3);
  if (wild && random.uniform(0, 1) < 0.15) s.sprawl = random.uniform(0.03, 0.1);
  s.neck *= wild ? random.uniform(0.7, 2.8) : about(0.25);
  s.neck_up = std::clamp(s.neck_up + random.typical(-25, 25), -12.0, 80.0);
  s.tail *= about(0.4);
  s.tail_up += random.typical(-40, 70);
  s.tail_thick *= random.uniform(0.7, 1.7);
  s.hump = random.uniform(0, 1) < 0.1 ? random.uniform(0.3, 1) : s.hump * random.uniform(0.3, 1.5);
}

void vary_head(Style& s, Random& random) {
  const double cute =
      (random.uniform(0, 1) < 0.3 ? random.uniform(0.2, 1) : 0) / std::max(1.0, 1.6 * s.muzzle);
  s.head *= random.typical(0.88, 1.15) * (1 + 0.9 * cute);
  s.height *= 1 - 0.25 * cute;
  s.neck *= 1 - 0.25 * cute;
  s.head_wide *= random.typical(0.85, 1.2) + 0.35 * cute;
  s.muzzle *= random.uniform(0.7, 1.35) * (1 - 0.5 * cute);
  s.muzzle_thick *= random.uniform(0.8, 1.25);
  s.nod += random.typical(-18, 25);
  s.ears *= random.uniform(0.7, 1.5);
  s.ear_up += random.typical(-50, 25);
  s.ear_wide *= random.uniform(0.8, 1.4);
  if (s.species == Species::any) {
    s.horns = random.uniform(0, 1) < 0.3 ? random.uniform(0.4, 1) : 0;
    s.mane = random.uniform(0, 1) < 0.2 ? 0.5 : 0;
    s.hooves = random.uniform(0, 1) < 0.4;
    s.trunk = random.uniform(0, 1) < 0.06 ? 0.7 : 0;
  }
  if (random.uniform(0, 1) > s.horns) s.horns = 0;
  if (s.horns > 0) s.horns = random.uniform(0.5, 1.8);
  if (random.uniform(0, 1) > s.mane) s.mane = 0;
  if (s.tail < 0.06) s.tail = 0.06;  // three bones want some room
}

Style random_style(Random& random) {
  const int kinds = static_cast<int>(Species::count);
  Style s = usual(static_cast<Species>(std::min(static_cast<int>(random.uniform(0, kinds + 2)), kinds - 1)));
  vary_trunk(s, random);
  vary_head(s, random);
  const double make = random.uniform(0, 1), wealth = random.uniform(0, 1);
  s.blocky = make > 0.9;
  s.make = make < 0.6 ? Make::skin : make < 0.75 ? Make::pieces : Make::tubes;
  s.sides = s.blocky ? 4 : static_cast<int>(5 + 11 * wealth * wealth + random.uniform(0, 2));
  s.vertices = static_cast<int>(300 * std::exp(2.1 * wealth));
  s.square = s.blocky ? 1 : random.uniform(0, 1) < 0.25 ? random.uniform(0.1, 0.5) : 0;
  return s;
}

void place_legs(Places& p, const Style& s) {
  const double y = s.height, c = s.crouch * std::min(1.0, y / 0.5), out = s.sprawl;
  const double w = std::max({0.085, 0.075 * s.barrel, 0.07 * s.limbs}),
               foot = std::min(0.045 * (0.6 + 0.4 * s.paws), 0.25 * y);
  const double step = 0.085 * s.paws;
  const auto side = [&](double x) { return w + x * out; };
  p.shoulder = {side(0), y + 0.01, p.neck.z() - 0.05};
  p.elbow = {side(1), 0.64 * y, p.shoulder.z() - 0.07 * c};
  p.wrist = {side(1.2), 0.3 * y, p.shoulder.z() - 0.035 * c};
  p.front_paw = {side(1.35), foot, p.shoulder.z() - 0.045 * c};
  p.front_toe = p.front_paw + Vec3(0, -0.3 * foot, step);
  p.hip = {side(0), y, p.hips.z()};
  p.knee = {side(0.8), 0.62 * y, p.hips.z() + 0.07 * c};
  p.hock = {side(1), 0.31 * y, p.hips.z() - 0.1 * c};
  p.hind_paw = {side(1.2), foot, p.hips.z() - 0.065 * c};
  p.hind_toe = p.hind_paw + Vec3(0, -0.3 * foot, 1.05 * step);
}

Places place(const Style& s) {
  Places p;
  const double y = s.height, up = s.neck_up * degree, nod = s.nod * degree;
  p.hips = {0, y + 0.05, -0.36};
  p.spine = {0, y + 0.06, -0.13};
  p.chest = {0, y + 0.06, 0.1};
  p.neck = {0, y + 0.1, 0.3};
  p.head = p.neck + s.neck * Vec3(0, std::sin(up), std::cos(up));
  p.along = Vec3(0, -std::sin(nod), std::cos(nod));
  p.nose = p.head + s.head * (0.14 + 0.11 * s.muzzle) * p.along;
  p.tail[0] = p.hips + Vec3(0, 0.03 * s.barrel, -0.1 - 0.02 * s.barrel);
  for (int i = 0; i < 3; ++i) {
    const double a = (s.tail_up * (1 - 0.35 * i) - 6 * i) * degree;
    p.tail[i + 1] = p.tail[i] + s.tail / 3 * Vec3(0, std::sin(a), -std::cos(a));
  }
  place_legs(p, s);
  const double ear = s.ear_up * degree;
  p.ear = p.head + s.head * Vec3(0.048 * s.head_wide, 0.052, -0.01);
  p.ear_tip = p.ear + s.head * s.ears * 0.11 * Vec3(std::cos(ear) * 0.9 + 0.1, std::sin(ear), -0.12);
  return p;
}

Bones skeleton(const Places& p) {
  Bones b;
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

}  // namespace

Plan plan_quadruped(Random& random) {
  const Style style = random_style(random);
  const Places at = place(style);
  return {style, at, skeleton(at)};
}

std::vector<Anchor> anchors(const Plan& plan) {
  const Places& p = plan.at;
  const Vec3 up = Vec3::UnitY(), down = -up, front = Vec3::UnitZ(), left = Vec3::UnitX();
  return {{"nose", p.nose - 0.04 * p.along, p.along},
          {"crown", p.head, up},
          {"withers", p.neck + Vec3(0, -0.05, -0.08), up},
          {"croup", p.hips, up},
          {"chest", p.neck + Vec3(0, -0.08, -0.05), front - 0.6 * up},
          {"belly", p.spine + Vec3(0, 0, 0.03), down},
          {"tailTip", p.tail[2], p.tail[3] - p.tail[2]},
          {"earTip", 0.7 * p.ear + 0.3 * p.ear_tip, p.ear_tip - p.ear, true},
          {"shoulder", p.shoulder, left, true},
          {"elbow", p.elbow, -front, true},
          {"frontToe", p.front_paw - Vec3(0, 0.1 * p.front_paw.y(), 0), front, true},
          {"knee", p.knee, front, true},
          {"hock", p.hock, -front, true},
          {"hindToe", p.hind_paw - Vec3(0, 0.1 * p.hind_paw.y(), 0), front, true}};
}

std::vector<Freedom> freedoms(const Plan& plan) {
  const Bones& b = plan.bones;
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  return {{b.spine, y, -10, 10},
          {b.chest, y, -10, 10},
          {b.neck, x, -15, 30},
          {b.neck, y, -25, 25},
          {b.head, x, -15, 15},
          {b.head, y, -20, 20},
          {b.head, z, -10, 10},
          {b.tail[0], y, -30, 30},
          {b.tail[1], y, -25, 25},
          {b.tail[2], y, -25, 25},
          {b.ear, z, -15, 10, true},
          {b.front_upper, x, -32, 25, true},
          {b.front_lower, x, -40, 5, true},
          {b.front_foot, x, -5, 40, true},
          {b.hind_upper, x, -30, 25, true},
          {b.hind_lower, x, -10, 35, true},
          {b.hind_foot, x, -30, 10, true}};
}

}  // namespace creatures::game::beast
