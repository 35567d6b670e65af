// The naked body of a game humanoid as sweeps, whatever its proportions.
#include <algorithm>
#include <cmath>

#include "game_humanoid.h"

namespace creatures::game {
namespace {

void add_torso(Flesh& flesh, const Plan& plan) {
  const Style& y = plan.style;
  const Places& p = plan.at;
  const Bones& b = plan.bones;
  const double w = p.width, d = w * y.depth, h = w * y.hips, s = w * y.shoulders, g = y.belly;
  const Vec3 bottom(0, p.hip.y() - 0.03, 0), top(0, p.neck.y() - 0.015, 0);
  const double hip = std::max(0.163 * h, p.hip.x() + 0.055 * w * y.limbs);
  flesh.torso.push_back({.from = bottom,
                         .to = top,
                         .front = Vec3::UnitZ(),
                         .sections = {{0.00, 0.75 * hip, 0.085 * d, 0.085 * d, -0.005},
                                      {0.12, hip, (0.098 + 0.02 * g) * d, 0.1 * d, -0.005},
                                      {0.30, 0.135 * w + 0.03 * g * w, (0.096 + 0.06 * g) * d, 0.078 * d},
                                      {0.48, 0.142 * w + 0.018 * g * w, (0.102 + 0.035 * g) * d, 0.084 * d},
                                      {0.68, 0.163 * s, 0.108 * d, 0.1 * d, -0.005},
                                      {0.86, 0.148 * s, 0.086 * d, 0.094 * d, -0.015},
                                      {1.00, 0.078 * s, 0.058 * d, 0.06 * d, -0.022}},
                         .start_cap = 0.05,
                         .end_cap = 0.03,
                         .bones = {{b.hips},
                                   {b.spine, 0.24, 0.12},
                                   {b.chest, 0.46, 0.12},
                                   {b.upper_chest, 0.70, 0.12},
                                   {b.neck, 0.985, 0.05}},
                         .blend = 0.05});
  const Vec3 collar = p.neck + Vec3(0.03 * w, -0.01, 0), outer = p.shoulder + Vec3(-0.01, 0.01, 0);
  const double t = 0.042 * w * (0.9 + 0.15 * y.muscle);
  flesh.torso.push_back({.from = collar,
                         .to = outer,
                         .front = Vec3::UnitZ(),
                         .sections = {{0, t, t, 1.1 * t, -0.005}, {1, t, t, 1.05 * t}},
                         .start_cap = 0.03,
                         .end_cap = 0.03,
                         .bones = {{b.upper_chest}, {b.shoulder, 0.35, 0.08}},
                         .blend = 0.06,
                         .paired = true});
}

void add_curves(Flesh& flesh, const Plan& plan) {
  const Style& y = plan.style;
  const Places& p = plan.at;
  const Bones& b = plan.bones;
  const double w = p.width, d = w * y.depth, h = w * y.hips, s = w * y.shoulders;
  const double bust = (0.02 + 0.022 * y.bust) * d;
  const Vec3 breast(0.078 * s, 0.45 * p.chest.y() + 0.55 * p.upper_chest.y(), 0.072 * d);
  flesh.torso.push_back(ellipsoid(breast, {0.062 * s, 0.065 * w, 0.025 * d + bust}, b.chest, 0.05));
  flesh.torso.back().paired = true;
  const Vec3 seat(0.07 * h, p.hip.y() + 0.01, -0.062 * d);
  flesh.torso.push_back(ellipsoid(seat, {0.075 * h, 0.085 * w, 0.062 * d}, b.hips, 0.05));
  flesh.torso.back().paired = true;
}

void add_arms(Flesh& flesh, const Plan& plan) {
  const Style& y = plan.style;
  const Places& p = plan.at;
  const Bones& b = plan.bones;
  const double l = p.width * y.limbs, m = l * (0.92 + 0.16 * y.muscle);
  Sweep upper = segment(p.shoulder, p.elbow,
                        {{0, 0.054 * m, 0.056 * m, 0.056 * m},
                         {0.42, 0.047 * m, 0.051 * m, 0.049 * m},
                         {1, 0.037 * l, 0.039 * l, 0.04 * l}},
                        {b.shoulder, b.upper_arm, b.lower_arm}, 0.09 * l, 0.055 * l);
  cap_round(upper, 1, 1);
  Sweep lower = segment(p.elbow, p.wrist,
                        {{0, 0.037 * l, 0.039 * l, 0.04 * l},
                         {0.3, 0.038 * m, 0.043 * m, 0.041 * m},
                         {1, 0.025 * l, 0.03 * l, 0.029 * l}},
                        {b.upper_arm, b.lower_arm, b.hand}, 0.07 * l, 0.05 * l);
  cap_round(lower, 1, 0.8);
  upper.detail = lower.detail = y.vertices < 900 ? 0.52 : 0.75;  // too few vertices would break thin ones
  flesh.arms = {upper, lower};
}

Sweep digit(const Plan& plan, const Vec3& from, const Vec3& to, double radius) {
  Sweep s = cone(from, to, radius, 0.8 * radius, plan.bones.hand, 0.5 * radius);
  s.detail = 0.5;
  s.paired = true;
  return s;
}

void add_fingers(Flesh& flesh, const Plan& plan, double size, double wrist) {
  const Places& p = plan.at;
  const int n = plan.style.fingers;
  const double wide = std::max(0.04 * size, 1.25 * wrist), radius = 0.86 * wide / n;
  for (int i = 0; i < n; ++i) {
    const double across = n == 1 ? 0 : 1 - 2.0 * i / (n - 1);
    const double length = (i == n - 1 ? 0.076 : i == 0 ? 0.09 : 0.1) * size;
    const Vec3 root = p.wrist + 0.082 * size * p.forearm + (wide - radius) * across * p.thumb;
    const Vec3 along = (p.forearm + 0.12 * across * p.thumb + 0.1 * p.palm).normalized();
    flesh.hands.push_back(digit(plan, root, root + (length - radius) * along, radius));
  }
}

void add_hands(Flesh& flesh, const Plan& plan) {
  const Places& p = plan.at;
  const Style& y = plan.style;
  const double size = (p.fingertip - p.wrist).norm() / 0.18, l = p.width * y.limbs;
  const double wrist = 0.028 * l, wide = std::max(0.042 * size, 1.2 * wrist),
               thick = std::max(0.019 * size, 0.8 * wrist);
  Sweep palm = segment(p.wrist, p.wrist + 0.085 * size * p.forearm,
                       {{0, wrist, 1.05 * wrist, 1.05 * wrist},
                        {0.5, thick, wide, wide},
                        {1, thick, 0.95 * wide, 0.95 * wide}},
                       {plan.bones.hand, plan.bones.hand, plan.bones.hand}, 0.01, 0.03 * l);
  palm.front = p.thumb;
  // Into the arm, which may be a surface of its own and, where triangles are large, ends early.
  const double into = y.vertices < 1000 ? 0.045 * l : 0.012 * l;
  palm.from -= into * p.forearm;
  palm.bones = {{plan.bones.lower_arm}, {plan.bones.hand, into / (into + 0.085 * size), 0.04 * l}};
  palm.start_cap = 0.5 * wrist;
  palm.end_cap = 0.6 * thick;
  palm.detail = 0.6;
  if (y.hand == Hand::mitten) {
    palm.to = p.fingertip - 0.02 * size * p.forearm;
    palm.sections = {{0, wrist, 1.05 * wrist, 1.05 * wrist},
                     {0.45, 1.1 * thick, wide, wide},
                     {0.8, thick, 0.85 * wide, 0.9 * wide},
                     {1, 0.8 * thick, 0.6 * wide, 0.65 * wide}};
    palm.end_cap = 0.02 * size;
  } else if (y.hand == Hand::fist) {
    palm.sections[1].side = palm.sections[2].side = 1.9 * thick;
    palm.end_cap = 1.2 * thick;
  }
  flesh.hands.push_back(palm);
  const Vec3 root = p.wrist + 0.025 * size * p.forearm + 0.6 * wide * p.thumb;
  const double fat = y.hand == Hand::fingers ? 0.9 * wide / y.fingers : 0.42 * wide;
  const Vec3 out = (0.8 * p.forearm + p.thumb + 0.15 * p.palm).normalized();
  flesh.hands.push_back(digit(plan, root, root + 0.075 * size * out, fat));
  if (y.hand == Hand::fingers) add_fingers(flesh, plan, size, wrist);
}

void add_legs(Flesh& flesh, const Plan& plan) {
  const Style& y = plan.style;
  const Places& p = plan.at;
  const Bones& b = plan.bones;
  const double l = p.width * y.limbs, m = l * (0.94 + 0.12 * y.muscle);
  Sweep lower = segment(p.ankle, p.knee,
                        {{0, 0.035 * l, 0.038 * l, 0.037 * l},
                         {0.2, 0.035 * l, 0.038 * l, 0.04 * l},
                         {0.65, 0.05 * m, 0.046 * m, 0.062 * m, -0.008},
                         {1, 0.049 * l, 0.053 * l, 0.049 * l}},
                        {b.foot, b.lower_leg, b.upper_leg}, 0.08 * l, 0.055 * l);
  cap_round(lower, 0.6, 1);
  Sweep upper = segment(p.knee, p.hip,
                        {{0, 0.05 * l, 0.054 * l, 0.05 * l},
                         {0.3, 0.06 * l, 0.062 * l, 0.058 * l},
                         {0.7, 0.076 * l, 0.08 * l, 0.078 * l},
                         {1, 0.08 * l, 0.085 * l, 0.085 * l}},
                        {b.lower_leg, b.upper_leg, b.hips}, 0.1 * l, 0.06 * l);
  cap_round(upper, 1, 0.8);
  upper.pair_blend = lower.pair_blend = 0.01;
  upper.detail = lower.detail = y.vertices < 900 ? 0.7 : 0.9;
  flesh.legs = {lower, upper};
}

void add_feet(Flesh& flesh, const Plan& plan) {
  const Places& p = plan.at;
  const double f = (p.toe_tip - p.toes).norm() / 0.075, a = p.sole, l = p.width * plan.style.limbs;
  const double wide = std::max(0.04 * f, 0.042 * l);
  const Vec3 heel = p.ankle + Vec3(-0.004, -0.55 * a, -0.02 * f);
  const Vec3 tip(p.toe_tip.x(), heel.y(), p.toe_tip.z() - 0.03 * f);
  flesh.feet.push_back({.from = heel,
                        .to = tip,
                        .front = Vec3::UnitY(),
                        .sections = {{0.0, 0.85 * wide, 0.6 * a, 0.45 * a},
                                     {0.3, 0.9 * wide, 0.65 * a, 0.45 * a},
                                     {0.7, 1.12 * wide, 0.32 * a, 0.45 * a},
                                     {1.0, wide, 0.18 * a, 0.42 * a, -0.03 * a}},
                        .start_cap = 0.03 * f,
                        .end_cap = 0.035 * f,
                        .bones = {{plan.bones.foot}, {plan.bones.toes, 0.74, 0.05 * f}},
                        .blend = 0.035,
                        .detail = 0.75,
                        .paired = true});
}

std::vector<Sweep> human_head(const Plan& plan) {
  const Style& y = plan.style;
  const Places& p = plan.at;
  const double h = p.skull_radii.y() / 0.096;
  const Vec3 o = p.skull - Vec3(0, 0.122 * h, 0);
  const double x = h * y.head_width, z = h * y.head_depth;
  const auto ball = [&](const Vec3& at, const Vec3& r, double blend) {
    Sweep s = ellipsoid(o + Vec3(x * at.x(), h * at.y(), z * at.z()), Vec3(x * r.x(), h * r.y(), z * r.z()),
                        plan.bones.head, blend * h);
    s.detail = 0.65;
    return s;
  };
  std::vector<Sweep> head{ball({0, 0, 0}, {0.05, 0.03, 0.05}, 0.03)};
  head[0].to = o + Vec3(0, 0.14 * h, 0);
  head[0].sections = {{0, 0.050 * x, 0.062 * z, 0.045 * z, 0.022 * z},
                      {0.3, 0.064 * x, 0.078 * z, 0.068 * z, 0.012 * z},
                      {0.6, 0.070 * x, 0.086 * z, 0.088 * z, 0.004 * z},
                      {1, 0.074 * x, 0.084 * z, 0.094 * z, 0.0}};
  head[0].end_cap = 0.078 * h;
  head.push_back(ball({0, -0.006, 0.066}, {0.026, 0.018, 0.02}, 0.03));
  if (y.nose > 0.25) {
    Sweep nose = ball({0, 0.052, 0.092}, {0.019 * y.nose, 0.015, 0.024 * y.nose}, 0.018);
    nose.to = o + Vec3(0, h * 0.098, z * 0.084);
    nose.sections.push_back({1, 0.011 * x * y.nose, 0.01 * z, 0.01 * z});
    head.push_back(nose);
  }
  for (const auto& [at, r, carve] :
       {std::tuple{Vec3(0.033, 0.086, 0.09), Vec3(0.02 * y.eyes, 0.014 * y.eyes, 0.014), true},
        std::tuple{Vec3(0.075, 0.07, -0.008), Vec3(0.016, 0.034, 0.018), false}}) {
    head.push_back(ball(at, r, 0.014));
    head.back().paired = true;
    head.back().carve = carve;
  }
  return head;
}

// A ball or an egg; a snout for animals.
std::vector<Sweep> round_head(const Plan& plan) {
  const Places& p = plan.at;
  const Vec3 r = p.skull_radii;
  const double tall = 1.24 * r.y();
  const Vec3 c = p.skull - Vec3(0, 0.26 * r.y(), 0);
  std::vector<Sweep> head{ellipsoid(c, {1.12 * r.x(), tall, 1.1 * r.z()}, plan.bones.head, 0.3 * r.y())};
  const double snout = plan.style.snout;
  if (snout > 0) {
    Sweep nose = ellipsoid(c + Vec3(0, -0.35 * tall, 0.6 * r.z()), {0.5 * r.x(), 0.36 * tall, 0.5 * r.z()},
                           plan.bones.head, 0.2 * r.y());
    nose.to = nose.from + Vec3(0, -0.06 * tall, 0.7 * snout * r.z());
    nose.front = Vec3::UnitY();
    nose.sections = {{0, 0.6 * r.x(), 0.4 * tall, 0.38 * tall}, {1, 0.42 * r.x(), 0.26 * tall, 0.26 * tall}};
    nose.start_cap = nose.end_cap = 0.25 * r.z();
    head.push_back(nose);
  }
  for (Sweep& s : head) s.detail = 0.8;
  return head;
}

void add_head(Flesh& flesh, const Plan& plan) {
  const Places& p = plan.at;
  const bool human = plan.style.kind == Kind::realistic || (plan.style.kind == Kind::stylised) ||
                     (plan.style.kind == Kind::chibi && plan.style.eyes < 1.75);
  flesh.head = human ? human_head(plan) : round_head(plan);
  const double w = 0.052 * std::pow(p.width, 0.6), low = 0.04;
  const double length = p.head.y() - p.neck.y() + low + 0.04;
  flesh.head.push_back({.from = p.neck - Vec3(0, low, 0),
                        .to = p.head + Vec3(0, 0.04, 0),
                        .front = Vec3::UnitZ(),
                        .sections = {{0, 1.2 * w, 1.1 * w, 1.1 * w}, {1, w, w, 1.05 * w}},
                        .start_cap = 0.02,
                        .end_cap = 0.02,
                        .bones = {{plan.bones.upper_chest},
                                  {plan.bones.neck, (low - 0.01) / length, 0.025},
                                  {plan.bones.head, 1 - 0.035 / length, 0.025}},
                        .blend = 0.04,
                        .detail = 0.8});
}

}  // namespace

std::vector<Sweep> Flesh::all() const {
  std::vector<Sweep> every;
  for (const auto* group : {&torso, &legs, &feet, &arms, &hands, &head})
    every.insert(every.end(), group->begin(), group->end());
  return every;
}

Flesh flesh_of(const Plan& plan) {
  Flesh flesh;
  add_torso(flesh, plan);
  add_curves(flesh, plan);
  add_arms(flesh, plan);
  add_hands(flesh, plan);
  add_legs(flesh, plan);
  add_feet(flesh, plan);
  add_head(flesh, plan);
  return flesh;
}

}  // namespace creatures::game
