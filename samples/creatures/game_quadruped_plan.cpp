// The range of game quadrupeds: style, places of the joints, skeleton.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "game_quadruped.h"

namespace creatures::game::beast {
namespace {

constexpr double degree = EIGEN_PI / 180;

// What is usual for a species; individuals vary around it.
constexpr Style usual[] = {
    {.species = Species::dog},
    {.species = Species::cat,
     .height = 0.48,
     .barrel = 0.9,
     .neck = 0.2,
     .head_wide = 1.2,
     .muzzle = 0.35,
     .ears = 0.8,
     .tail = 0.6},
    {.species = Species::horse,
     .hooves = true,
     .height = 0.72,
     .barrel = 1.5,
     .crouch = 0.75,
     .neck = 0.42,
     .neck_up = 52,
     .head = 1.15,
     .head_wide = 0.85,
     .muzzle = 1.5,
     .nod = 45,
     .ears = 0.7,
     .tail_up = -65,
     .mane = 0.6},
    {.species = Species::cow,
     .hooves = true,
     .height = 0.58,
     .barrel = 1.75,
     .waist = 1,
     .crouch = 0.6,
     .neck = 0.27,
     .neck_up = 25,
     .head = 1.2,
     .muzzle = 1.3,
     .muzzle_thick = 1.3,
     .nod = 35,
     .ears = 0.8,
     .ear_up = 0,
     .tail_up = -75,
     .horns = 0.6},
    {.species = Species::deer,
     .hooves = true,
     .height = 0.74,
     .barrel = 1.15,
     .limbs = 0.75,
     .neck = 0.38,
     .neck_up = 60,
     .head = 0.9,
     .muzzle = 1.2,
     .nod = 25,
     .ears = 1.1,
     .ear_up = 45,
     .tail = 0.13,
     .horns = 0.7},
    {.species = Species::pig,
     .hooves = true,
     .height = 0.4,
     .barrel = 1.65,
     .waist = 1.05,
     .limbs = 1.05,
     .crouch = 0.5,
     .neck = 0.2,
     .neck_up = 8,
     .head = 1.25,
     .muzzle = 1,
     .muzzle_thick = 1.4,
     .ears = 0.9,
     .tail = 0.16,
     .tail_thick = 0.6},
    {.species = Species::elephant,
     .height = 0.66,
     .barrel = 2.1,
     .waist = 1,
     .limbs = 2,
     .paws = 1.3,
     .crouch = 0.1,
     .neck = 0.26,
     .neck_up = 25,
     .head = 1.9,
     .muzzle = 0.5,
     .ears = 1.35,
     .ear_up = -30,
     .ear_wide = 2,
     .tail_up = -75,
     .tail_thick = 0.6,
     .trunk = 1},
    {.species = Species::bear,
     .height = 0.52,
     .barrel = 1.65,
     .waist = 1.05,
     .limbs = 1.6,
     .paws = 1.5,
     .crouch = 0.5,
     .neck = 0.22,
     .neck_up = 22,
     .head = 1.3,
     .head_wide = 1.15,
     .muzzle = 0.8,
     .ears = 0.6,
     .ear_wide = 1.4,
     .tail = 0.1,
     .hump = 0.4},
    {.species = Species::lizard,
     .height = 0.26,
     .barrel = 0.85,
     .waist = 1.05,
     .paws = 1.1,
     .crouch = 0.6,
     .sprawl = 0.15,
     .neck = 0.2,
     .neck_up = 12,
     .head = 1,
     .muzzle = 1.4,
     .nod = 5,
     .ears = 0.25,
     .tail = 0.95,
     .tail_up = -12,
     .tail_thick = 2.6},
    {.species = Species::any},
};

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
  const double kind =
      random.uniform(0, static_cast<double>(std::size(usual)) + 2);  // `any` counts three times
  Style s = usual[std::min(static_cast<size_t>(kind), std::size(usual) - 1)];
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

}  // namespace

Plan plan_quadruped(Random& random) {
  const Style style = random_style(random);
  const Places at = place(style);
  return {style, at, quadruped_skeleton(at)};
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
