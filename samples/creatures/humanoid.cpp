// People: 22 joints with VRM names, arms held away from the body.
#include "stock_bones.h"

namespace creatures {
namespace {

// Relative to an average adult, except where a unit is given.
struct Build {
  double legs, torso, arms, neck, head, shoulders, hips, limbs, muscle, belly, bust, feet, nose;
  double arm_drop;  // degrees below the horizontal
};

Build random_build(Random& random) {
  const double weight = random.uniform(0, 1);
  Build b;
  b.legs = random.typical(0.88, 1.12);
  b.torso = random.typical(0.9, 1.1);
  b.arms = random.typical(0.9, 1.1);
  b.neck = random.typical(0.75, 1.25);
  b.head = random.typical(0.96, 1.2);
  b.shoulders = random.uniform(0.92, 1.14);
  b.hips = random.uniform(0.9, 1.08) + 0.1 * weight;
  b.limbs = random.uniform(0.86, 1.02) + 0.22 * weight;
  b.muscle = random.uniform(0, 1);
  b.belly = random.typical(-0.3, 0.5) + 0.9 * weight;
  b.bust = random.uniform(-0.7, 1);
  b.feet = random.typical(0.9, 1.12);
  b.nose = random.typical(0.75, 1.1);
  b.arm_drop = random.uniform(40, 50);
  return b;
}

struct Places : HumanoidPlaces {
  Vec3 knuckles;
  Vec3 arm;  // direction from the shoulder to the hand
};
using Bones = HumanoidBones;

Places place(const Build& b) {
  Places p;
  const double y = 0.075 + 0.85 * b.legs, t = b.torso;
  p.hips = {0, y + 0.04, -0.005};
  p.spine = {0, y + 0.12 * t, -0.01};
  p.chest = {0, y + 0.24 * t, -0.015};
  p.upper_chest = {0, y + 0.37 * t, -0.02};
  p.neck = {0, y + 0.52 * t, -0.025};
  p.head = p.neck + Vec3(0, 0.085 * b.neck, 0.02);
  p.crown = p.head + Vec3(0, 0.215 * b.head, -0.005);
  p.clavicle = {0.03, y + 0.475 * t, 0};
  p.shoulder = {0.172 * b.shoulders, y + 0.452 * t, -0.02};
  const double drop = b.arm_drop * EIGEN_PI / 180;
  p.arm = Vec3(std::cos(drop), -std::sin(drop), 0);
  p.elbow = p.shoulder + 0.275 * b.arms * p.arm;
  p.wrist = p.elbow + 0.25 * b.arms * p.arm + Vec3(0, 0, 0.03);
  p.knuckles = p.wrist + 0.085 * b.arms * p.arm + Vec3(0, 0, 0.005);
  p.fingertip = p.wrist + 0.185 * b.arms * p.arm + Vec3(0, 0, 0.01);
  p.hip = {0.092 * b.hips, y, -0.005};
  p.knee = {0.092 * b.hips + 0.025, 0.075 + 0.42 * b.legs, 0.005};
  p.ankle = {0.092 * b.hips + 0.045, 0.078, -0.02};
  p.toes = p.ankle + Vec3(0.015, -0.05, 0.13 * b.feet);
  p.toe_tip = p.toes + Vec3(0.008, -0.005, 0.075 * b.feet);
  return p;
}

void add_torso(std::vector<Sweep>& flesh, const Build& b, const Places& p, const Bones& bones) {
  const Vec3 bottom(0, p.hip.y() - 0.03, 0), top(0, p.neck.y() - 0.015, 0);
  const double h = b.hips, s = b.shoulders, g = b.belly;
  flesh.push_back({.from = bottom,
                   .to = top,
                   .front = Vec3::UnitZ(),
                   .sections = {{0.00, 0.120 * h, 0.085, 0.085, -0.005},
                                {0.12, 0.163 * h, 0.098 + 0.02 * g, 0.098, -0.005},
                                {0.30, 0.137 * (0.5 + 0.5 * h) + 0.03 * g, 0.098 + 0.06 * g, 0.078, 0.0},
                                {0.48, 0.142 + 0.018 * g, 0.102 + 0.035 * g, 0.084, 0.0},
                                {0.68, 0.165 * s, 0.108, 0.100, -0.005},
                                {0.86, 0.150 * s, 0.086, 0.094, -0.015},
                                {1.00, 0.078 * s, 0.058, 0.060, -0.022}},
                   .start_cap = 0.05,
                   .end_cap = 0.04,
                   .bones = {{bones.hips},
                             {bones.spine, 0.24, 0.12},
                             {bones.chest, 0.46, 0.12},
                             {bones.upper_chest, 0.70, 0.12},
                             {bones.neck, 0.98, 0.06}},
                   .blend = 0.05});
  const Vec3 collar = p.neck + Vec3(0.03, -0.005, -0.005), outer = p.shoulder + Vec3(-0.015, 0.012, 0);
  flesh.push_back(
      {.from = collar,  // trapezius and collarbone
       .to = outer,
       .front = Vec3::UnitZ(),
       .sections = {{0, 0.045, 0.045, 0.048, -0.005}, {0.6, 0.040, 0.044, 0.05}, {1, 0.04, 0.042, 0.045}},
       .start_cap = 0.04,
       .end_cap = 0.03,
       .bones = {{bones.upper_chest}, {bones.shoulder, 0.35, 0.1}},
       .blend = 0.06,
       .paired = true});
  const double bust = 0.02 + 0.022 * b.bust;
  flesh.push_back({.from = Vec3(0.078 * s, p.chest.y() + 0.075 * b.torso, 0.078),
                   .to = Vec3(0.078 * s, p.chest.y() + 0.075 * b.torso, 0.078),
                   .front = Vec3::UnitZ(),
                   .sections = {{0, 0.062, 0.022 + bust, 0.04}},
                   .start_cap = 0.05,
                   .end_cap = 0.07,
                   .bones = {{bones.chest}},
                   .blend = 0.05,
                   .paired = true});
  flesh.push_back({.from = Vec3(0.072 * h, p.hip.y() + 0.01, -0.07),
                   .to = Vec3(0.072 * h, p.hip.y() + 0.01, -0.07),
                   .front = Vec3::UnitZ(),
                   .sections = {{0, 0.072 * h, 0.05, 0.062}},
                   .start_cap = 0.075,
                   .end_cap = 0.09,
                   .bones = {{bones.hips}},
                   .blend = 0.05,
                   .paired = true});
}

void add_head(std::vector<Sweep>& flesh, const Build& b, const Places& p, const Bones& bones) {
  const double h = b.head;
  const auto ball = [&](const Vec3& at, const Vec3& radii, double blend) {
    Sweep s = ellipsoid(p.head + h * at, h * radii, bones.head, blend);
    s.detail = 0.6;
    return s;
  };
  flesh.push_back({.from = p.neck - Vec3(0, 0.05, 0.0),
                   .to = p.head + Vec3(0, 0.04, 0.0),
                   .front = Vec3::UnitZ(),
                   .sections = {{0, 0.066, 0.06, 0.06}, {0.6, 0.054, 0.055, 0.055}, {1, 0.05, 0.05, 0.055}},
                   .start_cap = 0.03,
                   .end_cap = 0.03,
                   .bones = {{bones.upper_chest}, {bones.neck, 0.3, 0.05}, {bones.head, 0.75, 0.05}},
                   .blend = 0.045,
                   .detail = 0.8});
  flesh.push_back({.from = p.head - Vec3(0, 0.005, 0) * h,
                   .to = p.head + Vec3(0, 0.14, 0) * h,
                   .front = Vec3::UnitZ(),
                   .sections = {{0, 0.050 * h, 0.062 * h, 0.045 * h, 0.022 * h},
                                {0.3, 0.064 * h, 0.078 * h, 0.068 * h, 0.012 * h},
                                {0.6, 0.069 * h, 0.086 * h, 0.088 * h, 0.004 * h},
                                {1, 0.073 * h, 0.084 * h, 0.094 * h, 0.0}},
                   .start_cap = 0.03 * h,
                   .end_cap = 0.078 * h,
                   .bones = {{bones.head}},
                   .blend = 0.03,
                   .detail = 0.6});
  flesh.push_back(ball({0, -0.008, 0.066}, {0.026, 0.018, 0.02}, 0.03));        // chin
  Sweep nose = ball({0, 0.052, 0.092}, {0.019, 0.015, 0.024 * b.nose}, 0.018);  // nose, up to
  nose.to = p.head + h * Vec3(0, 0.098, 0.084);                                 // between the eyes
  nose.sections = {{0, 0.018 * h, 0.028 * h * b.nose, 0.02 * h}, {1, 0.011 * h, 0.010 * h, 0.01 * h}};
  flesh.push_back(nose);
  Sweep brow = ball({0.028, 0.112, 0.071}, {0.03, 0.012, 0.016}, 0.02);
  brow.paired = true;
  flesh.push_back(brow);
  Sweep eye = ball({0.031, 0.086, 0.092}, {0.018, 0.012, 0.012}, 0.016);
  eye.paired = eye.carve = true;
  flesh.push_back(eye);
  Sweep mouth = ball({0, 0.021, 0.098}, {0.026, 0.005, 0.01}, 0.012);
  mouth.carve = true;
  flesh.push_back(mouth);
  Sweep ear = ball({0.072, 0.07, -0.008}, {0.014, 0.034, 0.016}, 0.012);
  ear.paired = true;
  flesh.push_back(ear);
}

void add_arm(std::vector<Sweep>& flesh, const Build& b, const Places& p, const Bones& bones) {
  // Across the arm: `front` is z, where the thumb is; `side` points down and inwards, where the palm looks.
  const double w = b.limbs, m = w * (0.94 + 0.12 * b.muscle);
  const Vec3 end = p.shoulder + 0.545 * b.arms * p.arm;  // a little past the wrist
  flesh.push_back({.from = p.shoulder,
                   .to = end,
                   .front = Vec3::UnitZ(),
                   .sections = {{0.00, 0.056 * m, 0.056 * m, 0.056 * m, 0.0},
                                {0.22, 0.047 * m, 0.050 * m, 0.049 * m, 0.002},
                                {0.42, 0.039 * w, 0.041 * w, 0.041 * w, 0.0},
                                {0.515, 0.036 * w, 0.038 * w, 0.040 * w, 0.0},
                                {0.65, 0.037 * m, 0.042 * m, 0.040 * m, 0.008},
                                {0.92, 0.023 * w, 0.029 * w, 0.028 * w, 0.027},
                                {1.00, 0.021, 0.031, 0.031, 0.031}},
                   .start_cap = 0.055 * m,
                   .end_cap = 0.025,
                   .bones = {{bones.shoulder},
                             {bones.upper_arm, 0.0, 0.10},
                             {bones.lower_arm, 0.505, 0.08},
                             {bones.hand, 0.96, 0.05}},
                   .blend = 0.06});
  flesh.push_back({.from = p.wrist + 0.01 * p.arm,
                   .to = p.fingertip - 0.024 * p.arm,
                   .front = Vec3::UnitZ(),
                   .sections = {{0, 0.020, 0.031, 0.031},
                                {0.45, 0.021, 0.044, 0.043},
                                {0.8, 0.018, 0.039, 0.040},
                                {1, 0.015, 0.029, 0.030}},
                   .start_cap = 0.02,
                   .end_cap = 0.026,
                   .bones = {{bones.hand}},
                   .blend = 0.035,
                   .detail = 0.6});
  const Vec3 thumb = p.wrist + 0.012 * p.arm + Vec3(0, 0, 0.012);
  flesh.push_back(
      {.from = thumb,
       .to = thumb + 0.055 * p.arm + Vec3(0, 0, 0.078) + 0.008 * Vec3(p.arm.y(), -p.arm.x(), 0),
       .front = Vec3::UnitY(),
       .sections = {{0, 0.018, 0.021, 0.021}, {0.65, 0.014, 0.015, 0.015}, {1, 0.0115, 0.0125, 0.0125}},
       .start_cap = 0.015,
       .end_cap = 0.013,
       .bones = {{bones.hand}},
       .blend = 0.03,
       .detail = 0.6});
  for (size_t i = flesh.size() - 3; i < flesh.size(); ++i) flesh[i].paired = true;
}

void add_leg(std::vector<Sweep>& flesh, const Build& b, const Places& p, const Bones& bones) {
  const double w = b.limbs, m = w * (0.95 + 0.1 * b.muscle);
  flesh.push_back({.from = p.ankle - Vec3(0, 0.01, 0),
                   .to = p.hip,
                   .front = Vec3::UnitZ(),
                   .sections = {{0.00, 0.034 * w, 0.038 * w, 0.036 * w, 0.0},
                                {0.08, 0.033 * w, 0.036 * w, 0.038 * w, 0.0},
                                {0.30, 0.050 * m, 0.045 * m, 0.062 * m, -0.010},
                                {0.43, 0.047 * w, 0.046 * w, 0.050 * w, -0.004},
                                {0.50, 0.050 * w, 0.056 * w, 0.048 * w, 0.004},
                                {0.60, 0.058 * w, 0.060 * w, 0.056 * w, 0.004},
                                {0.82, 0.075 * w, 0.080 * w, 0.078 * w, 0.0},
                                {1.00, 0.080 * w, 0.084 * w, 0.085 * w, 0.0}},
                   .start_cap = 0.03,
                   .end_cap = 0.06,
                   .bones = {{bones.foot},
                             {bones.lower_leg, 0.02, 0.06},
                             {bones.upper_leg, 0.50, 0.11},
                             {bones.hips, 1.02, 0.12}},
                   .blend = 0.06,
                   .paired = true,
                   .pair_blend = 0.02});
  // The foot lies along its own axis: `front` is up, the sole is the flat back half.
  const Vec3 heel = p.ankle + Vec3(-0.004, -0.044, -0.02), tip = p.toe_tip + Vec3(0, -0.002, -0.03);
  const Vec3 along = tip - heel;
  const double f = b.feet;
  flesh.push_back({.from = heel,
                   .to = heel + Vec3(along.x(), 0, along.z()),
                   .front = Vec3::UnitY(),
                   .sections = {{0.0, 0.034 * f, 0.045, 0.034},
                                {0.3, 0.034 * f, 0.055, 0.030},
                                {0.7, 0.045 * f, 0.026, 0.030, -0.002},
                                {1.0, 0.042 * f, 0.014, 0.022, -0.010}},
                   .start_cap = 0.032 * f,
                   .end_cap = 0.030 * f,
                   .bones = {{bones.foot}, {bones.toes, 0.78, 0.05}},
                   .blend = 0.035,
                   .detail = 0.75,
                   .paired = true});
  const Vec3 big_toe = tip + Vec3(-0.024 * f, -0.002, 0.012);
  flesh.push_back({.from = big_toe - Vec3(0, 0, 0.03),
                   .to = big_toe,
                   .front = Vec3::UnitY(),
                   .sections = {{0, 0.018, 0.016, 0.018}, {1, 0.017, 0.014, 0.018}},
                   .start_cap = 0.02,
                   .end_cap = 0.02,
                   .bones = {{bones.toes}},
                   .blend = 0.015,
                   .detail = 0.7,
                   .paired = true});
}

std::vector<Anchor> anchors(const Build& b, const Places& p) {
  const Vec3 front = Vec3::UnitZ(), back = -front, down = -Vec3::UnitY();
  const Vec3 toe_root = p.toes + Vec3(0, -0.01, 0);
  return humanoid_anchors(
      p,
      {{"crown", p.head + Vec3(0, 0.1, 0), Vec3::UnitY()},
       {"nose", p.head + b.head * Vec3(0, 0.055, 0.05), front},
       {"chin", p.head + b.head * Vec3(0, -0.005, 0.05), front + 0.5 * down}},
      {{"handTip", p.wrist + 0.05 * p.arm, p.arm, true},
       {"thumbTip", p.wrist + 0.04 * p.arm + Vec3(0, 0, 0.052), 0.055 * p.arm + Vec3(0, 0, 0.078), true}},
      {{"heel", p.ankle + Vec3(0, -0.04, 0), back, true},
       {"toeTip", toe_root, p.toe_tip - toe_root + 0.003 * Vec3::UnitY(), true}});
}

std::vector<Freedom> freedoms(const Places& p, const Bones& bones) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const Vec3 flex = p.arm.cross(z);  // brings the forearm forward
  return {{bones.spine, x, -8, 22},
          {bones.spine, y, -10, 10},
          {bones.spine, z, -8, 8},
          {bones.chest, x, -5, 12},
          {bones.chest, y, -12, 12},
          {bones.upper_chest, y, -8, 8},
          {bones.neck, x, -10, 15},
          {bones.head, x, -12, 18},
          {bones.head, y, -40, 40},
          {bones.head, z, -12, 12},
          {bones.lower_arm, flex, 0, 110, true},
          {bones.hand, flex, -15, 35, true},
          {bones.upper_arm, p.arm, -40, 40, true},
          {bones.upper_arm, y, -60, 25, true},
          {bones.upper_arm, z, -22, 75, true},
          {bones.shoulder, z, -4, 12, true},
          {bones.lower_leg, x, 0, 80, true},
          {bones.foot, x, -15, 25, true},
          {bones.upper_leg, y, -10, 25, true},
          {bones.upper_leg, z, -4, 25, true},
          {bones.upper_leg, x, -65, 20, true}};
}

}  // namespace

Design design_humanoid(Random& random) {
  const Build build = random_build(random);
  const Places places = place(build);
  const Bones bones = humanoid_skeleton(places);
  std::vector<Sweep> flesh;
  add_torso(flesh, build, places, bones);
  add_leg(flesh, build, places, bones);
  add_arm(flesh, build, places, bones);
  add_head(flesh, build, places, bones);
  return {bones.all,
          Body(flesh, bones.all.mirror, random_asymmetry(random, 0.0015)),
          anchors(build, places),
          freedoms(places, bones),
          0.0125,
          random.typical(0.9, 1.1)};
}

}  // namespace creatures
