// Six-legged animals: head with mandibles and antennae, thorax, waist and abdomen. Designed in centimetres.
#include "design.h"

namespace creatures {
namespace {

// Relative to an average insect.
struct Build {
  double head, thorax, abdomen, abdomen_long, legs, leg_thick, antennae, mandibles, eyes, stance;
};

Build random_build(Random& random) {
  Build b;
  b.head = random.uniform(0.85, 1.2);
  b.thorax = random.typical(0.85, 1.15);
  b.abdomen = random.uniform(0.8, 1.25);
  b.abdomen_long = random.uniform(0.85, 1.2);
  b.legs = random.uniform(0.88, 1.15);
  b.leg_thick = random.uniform(0.88, 1.2);
  b.antennae = random.uniform(0.8, 1.2);
  b.mandibles = random.uniform(0.85, 1.2);
  b.eyes = random.uniform(0.8, 1.2);
  b.stance = random.typical(0.85, 1.2);
  return b;
}

struct Leg {
  const char* name;
  Vec3 hip, knee, ankle, tip;
};

struct Places {
  Vec3 thorax, neck, head, mouth, waist, abdomen, abdomen_tip;
  Vec3 antenna[3], mandible[3];
  Leg legs[3];
};

Places place(const Build& b) {
  Places p;
  const double y = 0.36 * b.stance;
  p.waist = {0, y, -0.13};
  p.thorax = {0, y + 0.02, 0.02};
  p.neck = {0, y + 0.03, 0.22 * b.thorax};
  p.head = p.neck + Vec3(0, 0.005, 0.02 + 0.13 * b.head);
  p.mouth = p.head + Vec3(0, -0.05, 0.095) * b.head;
  p.abdomen = {0, y + 0.02, -0.25};
  p.abdomen_tip = p.abdomen + b.abdomen_long * Vec3(0, -0.04, -0.56);
  const double a = b.antennae;
  p.antenna[0] = p.head + b.head * Vec3(0.045, 0.035, 0.045);
  p.antenna[1] = p.antenna[0] + a * Vec3(0.13, 0.19, 0.13);
  p.antenna[2] = p.antenna[1] + a * Vec3(0.12, -0.03, 0.30);
  const double m = b.mandibles * b.head;
  p.mandible[0] = p.head + b.head * Vec3(0.062, -0.045, 0.075);
  p.mandible[1] = p.mandible[0] + m * Vec3(0.05, -0.015, 0.10);
  p.mandible[2] = p.mandible[1] + m * Vec3(-0.06, -0.01, 0.085);
  const char* names[3] = {"Front", "Middle", "Hind"};
  for (int i = 0; i < 3; ++i) {
    const double forward[3] = {0.5, -0.08, -0.65}, length[3] = {0.88, 0.98, 1.28},
                 root[3] = {0.12, 0.02, -0.08};
    const Vec3 out = Vec3(1, 0, forward[i]).normalized();
    const double l = b.legs * length[i];
    Leg& leg = p.legs[i];
    leg.name = names[i];
    leg.hip = Vec3(0.04, y - 0.02, root[i] * b.thorax);
    leg.knee = leg.hip + l * (0.30 * out + Vec3(0, 0.20, 0));
    leg.ankle = leg.knee + l * 0.24 * out;
    leg.ankle.y() = 0.07;
    leg.tip = leg.ankle + l * 0.13 * out;
    leg.tip.y() = 0.0;
  }
  return p;
}

struct Bones {
  Skeleton all;
  int thorax, head, abdomen[2], antenna[2], mandible, femur[3], tibia[3], tarsus[3];
};

Bones skeleton(const Places& p) {
  Bones b;
  const Vec3 middle = 0.5 * (p.abdomen + p.abdomen_tip);
  b.thorax = b.all.add("thorax", -1, p.thorax, p.neck);
  b.head = b.all.add("head", b.thorax, p.neck, p.mouth);
  b.abdomen[0] = b.all.add("abdomen1", b.thorax, p.waist, middle);
  b.abdomen[1] = b.all.add("abdomen2", b.abdomen[0], middle, p.abdomen_tip);
  b.antenna[0] = b.all.add_pair("Antenna1", b.head, p.antenna[0], p.antenna[1]);
  b.antenna[1] = b.all.add_pair("Antenna2", b.antenna[0], p.antenna[1], p.antenna[2]);
  b.mandible = b.all.add_pair("Mandible", b.head, p.mandible[0], p.mandible[2]);
  for (int i = 0; i < 3; ++i) {
    const Leg& leg = p.legs[i];
    b.femur[i] = b.all.add_pair(std::string(leg.name) + "Femur", b.thorax, leg.hip, leg.knee);
    b.tibia[i] = b.all.add_pair(std::string(leg.name) + "Tibia", b.femur[i], leg.knee, leg.ankle);
    b.tarsus[i] = b.all.add_pair(std::string(leg.name) + "Tarsus", b.tibia[i], leg.ankle, leg.tip);
  }
  return b;
}

void add_trunk(std::vector<Sweep>& flesh, const Build& b, const Places& p, const Bones& bones) {
  const double t = b.thorax, a = b.abdomen;
  flesh.push_back({.from = p.waist,
                   .to = p.neck,
                   .front = Vec3::UnitY(),
                   .sections = {{0, 0.05, 0.05, 0.05},
                                {0.3, 0.088 * t, 0.075 * t, 0.085 * t},
                                {0.65, 0.108 * t, 0.105 * t, 0.095 * t},
                                {0.9, 0.075 * t, 0.078 * t, 0.07 * t},
                                {1, 0.052, 0.052, 0.05}},
                   .start_cap = 0.04,
                   .end_cap = 0.03,
                   .bones = {{bones.thorax}},
                   .blend = 0.04,
                   .detail = 0.85});
  // Four plates, each a little wider than the groove behind it.
  flesh.push_back({.from = p.waist + Vec3(0, 0, -0.02),
                   .to = p.abdomen_tip,
                   .front = Vec3::UnitY(),
                   .sections = {{0.00, 0.045, 0.045, 0.045},
                                {0.10, 0.058, 0.056, 0.054},
                                {0.26, 0.140 * a, 0.125 * a, 0.110 * a},
                                {0.40, 0.185 * a, 0.165 * a, 0.135 * a},
                                {0.44, 0.178 * a, 0.157 * a, 0.133 * a},
                                {0.58, 0.188 * a, 0.165 * a, 0.135 * a},
                                {0.63, 0.175 * a, 0.152 * a, 0.130 * a},
                                {0.76, 0.155 * a, 0.135 * a, 0.112 * a},
                                {0.81, 0.135 * a, 0.117 * a, 0.100 * a},
                                {0.93, 0.080 * a, 0.070 * a, 0.062 * a},
                                {1.00, 0.035, 0.032, 0.032}},
                   .start_cap = 0.04,
                   .end_cap = 0.035,
                   .bones = {{bones.thorax}, {bones.abdomen[0], 0.03, 0.06}, {bones.abdomen[1], 0.55, 0.25}},
                   .blend = 0.03});
}

void add_head(std::vector<Sweep>& flesh, const Build& b, const Places& p, const Bones& bones) {
  const double h = b.head;
  flesh.push_back({.from = p.head + h * Vec3(0, 0.015, -0.05),
                   .to = p.mouth,
                   .front = Vec3::UnitY(),
                   .sections = {{0, 0.098 * h, 0.085 * h, 0.080 * h},
                                {0.5, 0.112 * h, 0.080 * h, 0.078 * h},
                                {1, 0.058 * h, 0.046 * h, 0.043 * h}},
                   .start_cap = 0.075 * h,
                   .end_cap = 0.035 * h,
                   .bones = {{bones.head}},
                   .blend = 0.04,
                   .detail = 0.75});
  const double e = h * b.eyes;
  Sweep eye =
      ellipsoid(p.head + h * Vec3(0.085, 0.035, 0.02), e * Vec3(0.032, 0.042, 0.05), bones.head, 0.01);
  eye.paired = true;
  eye.detail = 0.6;
  flesh.push_back(eye);
  const auto limb = [&](const Vec3& from, const Vec3& to, double r0, double r1, BoneSpan root, BoneSpan own,
                        double blend) {
    Sweep s = cone(from, to, r0, r1, own.bone, blend);
    s.bones = {root, own};
    s.paired = true;
    s.detail = 0.45;
    flesh.push_back(s);
  };
  limb(p.antenna[0], p.antenna[1], 0.026, 0.021, {bones.head}, {bones.antenna[0], 0.25, 0.06}, 0.02);
  limb(p.antenna[1], p.antenna[2], 0.021, 0.026, {bones.antenna[0]}, {bones.antenna[1], 0, 0.05}, 0.01);
  limb(p.mandible[0], p.mandible[1], 0.032 * h, 0.025 * h, {bones.head}, {bones.mandible, 0.35, 0.06}, 0.025);
  limb(p.mandible[1], p.mandible[2], 0.025 * h, 0.018, {bones.mandible}, {bones.mandible}, 0.015);
}

void add_legs(std::vector<Sweep>& flesh, const Build& b, const Places& p, const Bones& bones) {
  const double thick[3] = {0.95, 0.95, 1.15};  // hind legs carry most
  for (int i = 0; i < 3; ++i) {
    const Leg& leg = p.legs[i];
    const double w = thick[i] * b.leg_thick;
    const auto part = [&](const Vec3& from, const Vec3& to, std::array<double, 3> r, BoneSpan root,
                          BoneSpan own) {
      Sweep s = cone(from, to, r[0] * w, r[2] * w, own.bone, 0.012);
      s.sections.insert(s.sections.begin() + 1, {0.35, r[1] * w, r[1] * w, r[1] * w});
      s.bones = {root, own};
      s.paired = true;
      s.detail = 0.5;
      flesh.push_back(s);
    };
    part(leg.hip, leg.knee, {0.043, 0.040, 0.028}, {bones.thorax}, {bones.femur[i], 0.15, 0.08});
    flesh.back().blend = 0.03;
    part(leg.knee, leg.ankle, {0.029, 0.033, 0.023}, {bones.femur[i]}, {bones.tibia[i], 0, 0.06});
    part(leg.ankle, leg.tip, {0.023, 0.023, 0.021}, {bones.tibia[i]}, {bones.tarsus[i], 0, 0.05});
  }
}

std::vector<Anchor> anchors(const Places& p) {
  const Vec3 up = Vec3::UnitY();
  std::vector<Anchor> all{{"head", p.head, up},
                          {"thorax", p.thorax + Vec3(0, 0, 0.05), up},
                          {"sternum", p.thorax + Vec3(0, 0, 0.05), -up},
                          {"abdomen", 0.5 * (p.abdomen + p.abdomen_tip), up},
                          {"abdomenTip", 0.2 * p.abdomen + 0.8 * p.abdomen_tip, p.abdomen_tip - p.abdomen},
                          {"eye", p.head + Vec3(0, 0.035, 0.02), Vec3::UnitX(), true},
                          {"antennaTip", p.antenna[1], p.antenna[2] - p.antenna[1], true},
                          {"mandibleTip", p.mandible[1], p.mandible[2] - p.mandible[1], true}};
  const char* names[3] = {"front", "middle", "hind"};
  for (int i = 0; i < 3; ++i) {
    all.push_back({std::string(names[i]) + "Knee", p.legs[i].knee, up, true});
    all.push_back({std::string(names[i]) + "Tip", p.legs[i].ankle, p.legs[i].tip - p.legs[i].ankle, true});
  }
  return all;
}

std::vector<Freedom> freedoms(const Bones& b, const Places& p) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  std::vector<Freedom> all{{b.head, x, -15, 20},
                           {b.head, y, -25, 25},
                           {b.head, z, -10, 10},
                           {b.abdomen[0], x, -20, 15},
                           {b.abdomen[0], y, -12, 12},
                           {b.abdomen[1], x, -10, 10},
                           {b.antenna[0], y, -25, 25, true},
                           {b.antenna[0], x, -25, 25, true},
                           {b.antenna[1], x, -30, 30, true},
                           {b.antenna[1], y, -25, 25, true},
                           {b.mandible, y, -12, 12, true}};
  for (int i = 0; i < 3; ++i) {
    const Vec3 lift = (p.legs[i].tip - p.legs[i].hip).cross(y);
    all.push_back({b.tibia[i], lift, -25, 30, true});
    all.push_back({b.tarsus[i], lift, -25, 25, true});
    all.push_back({b.femur[i], lift, -15, 18, true});
    all.push_back({b.femur[i], y, -20, 20, true});
  }
  return all;
}

}  // namespace

Design design_insect(Random& random) {
  const Build build = random_build(random);
  const Places places = place(build);
  const Bones bones = skeleton(places);
  std::vector<Sweep> flesh;
  add_trunk(flesh, build, places, bones);
  add_head(flesh, build, places, bones);
  add_legs(flesh, build, places, bones);
  return {bones.all,       Body(flesh, bones.all.mirror, random_asymmetry(random, 0.001)),
          anchors(places), freedoms(bones, places),
          0.0115,          0.02 * random.typical(0.8, 1.25)};
}

}  // namespace creatures
