// Right hands with a piece of forearm: fingers up, palm forward. Designed in decimetres.
#include "design.h"

namespace creatures {
namespace {

struct Finger {
  const char* name;
  Vec3 knuckle;
  double lean;  // degrees towards the thumb
  double length, radius;
};

// Relative to an average hand.
struct Build {
  double width, thickness, fingers, fingers_thick, thumb, pads;
};

struct Bones {
  Skeleton all;
  int arm, hand, thumb[3], finger[4][3];
};

struct Places {
  Vec3 elbow_end, wrist, palm_end;
  Vec3 thumb[4];
  Finger fingers[4];
  Vec3 finger[4][4];
};

Places place(const Build& b, Random& random) {
  Places p;
  p.elbow_end = {0, -0.75, 0};
  p.wrist = {0, 0, 0};
  p.palm_end = {0.02, 0.90, 0};
  const double w = b.width, f = b.fingers;
  p.fingers[0] = {"Index", Vec3(0.330 * w, 0.90, 0.0), 8, 0.78 * f, 0.094};
  p.fingers[1] = {"Middle", Vec3(0.110 * w, 0.95, -0.01), 2, 0.87 * f, 0.097};
  p.fingers[2] = {"Ring", Vec3(-0.110 * w, 0.91, -0.005), -5, 0.80 * f, 0.091};
  p.fingers[3] = {"Little", Vec3(-0.315 * w, 0.80, 0.01), -14, 0.62 * f, 0.080};
  for (int i = 0; i < 4; ++i) {
    Finger& finger = p.fingers[i];
    finger.length *= random.typical(0.93, 1.07);
    finger.radius *= b.fingers_thick * w;  // narrow hands have thin fingers
    const double lean = (finger.lean + random.uniform(-0.7, 0.7)) * EIGEN_PI / 180;
    const Vec3 along(std::sin(lean), std::cos(lean), 0.04);
    const double joints[4] = {0, 0.46, 0.75, 1};
    for (int k = 0; k < 4; ++k) p.finger[i][k] = finger.knuckle + joints[k] * finger.length * along;
  }
  const double t = b.thumb;
  p.thumb[0] = {0.20 * w, 0.16, 0.07};
  p.thumb[1] = p.thumb[0] + t * Vec3(0.27, 0.30, 0.10);
  p.thumb[2] = p.thumb[1] + t * Vec3(0.19, 0.28, 0.05);
  p.thumb[3] = p.thumb[2] + t * Vec3(0.13, 0.25, 0.02);
  return p;
}

Bones skeleton(const Places& p) {
  Bones b;
  b.arm = b.all.add("rightLowerArm", -1, p.elbow_end, p.wrist);
  b.hand = b.all.add("rightHand", b.arm, p.wrist, p.palm_end);
  const char* thumb[3] = {"Metacarpal", "Proximal", "Distal"};
  const char* finger[3] = {"Proximal", "Intermediate", "Distal"};
  for (int k = 0; k < 3; ++k)
    b.thumb[k] = b.all.add(std::string("rightThumb") + thumb[k], k == 0 ? b.hand : b.thumb[k - 1], p.thumb[k],
                           p.thumb[k + 1]);
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k)
      b.finger[i][k] = b.all.add(std::string("right") + p.fingers[i].name + finger[k],
                                 k == 0 ? b.hand : b.finger[i][k - 1], p.finger[i][k], p.finger[i][k + 1]);
  return b;
}

void add_palm(std::vector<Sweep>& flesh, const Build& b, const Places& p, const Bones& bones) {
  const double w = b.width, t = b.thickness;
  flesh.push_back({.from = p.elbow_end,
                   .to = p.palm_end,
                   .front = Vec3::UnitZ(),
                   .sections = {{0.00, 0.330 * w, 0.260 * t, 0.250 * t},
                                {0.25, 0.285 * w, 0.215 * t, 0.205 * t},
                                {0.46, 0.262 * w, 0.180 * t, 0.170 * t},
                                {0.62, 0.345 * w, 0.160 * t, 0.165 * t},
                                {0.85, 0.410 * w, 0.120 * t, 0.150 * t},
                                {1.00, 0.395 * w, 0.095 * t, 0.115 * t}},
                   .start_cap = 0.12,
                   .end_cap = 0.12,
                   .bones = {{bones.arm}, {bones.hand, 0.465, 0.25}},
                   .blend = 0.1});
  const double pad = 0.07 * b.pads * t;
  flesh.push_back(ellipsoid({-0.20 * w, 0.30, 0.09}, {0.16 * w, 0.30, pad + 0.04}, bones.hand, 0.22));
  flesh.push_back(ellipsoid({0.02, 0.76, 0.05}, {0.34 * w, 0.13, pad}, bones.hand, 0.2));
  flesh.push_back(ellipsoid({0.02, 0.50, 0.26}, {0.13 * w, 0.19, 0.12}, bones.hand, 0.2));  // the hollow
  flesh.back().carve = true;
}

void add_fingers(std::vector<Sweep>& flesh, const Places& p, const Bones& bones) {
  for (int i = 0; i < 4; ++i) {
    const double r = p.fingers[i].radius;
    const Vec3 start = p.finger[i][0] - 0.25 * (p.finger[i][1] - p.finger[i][0]);
    const Vec3 tip = p.finger[i][3], along = (tip - start).normalized(), end = tip - r * along;
    const double length = (end - start).norm();
    const auto at = [&](int k) { return (p.finger[i][k] - start).norm() / length; };
    // The joints are thicker than the bones between, the pads soft towards the palm, the nails flat.
    flesh.push_back({.from = start,
                     .to = end,
                     .front = Vec3::UnitZ(),
                     .sections = {{0, 0.95 * r, 1.0 * r, 1.15 * r},
                                  {at(0), 1.0 * r, 1.0 * r, 1.25 * r},
                                  {0.5 * (at(0) + at(1)), 0.98 * r, 1.05 * r, 0.95 * r},
                                  {at(1), 1.0 * r, 0.93 * r, 1.05 * r},
                                  {0.5 * (at(1) + at(2)), 0.90 * r, 0.95 * r, 0.85 * r},
                                  {at(2), 0.90 * r, 0.84 * r, 0.88 * r},
                                  {1, 0.82 * r, 0.86 * r, 0.62 * r}},
                     .start_cap = r,
                     .end_cap = 0.85 * r,
                     .bones = {{bones.hand},
                               {bones.finger[i][0], at(0), 0.16},
                               {bones.finger[i][1], at(1), 0.10},
                               {bones.finger[i][2], at(2), 0.08}},
                     .blend = 0.05,
                     .detail = 0.7});
  }
}

void add_thumb(std::vector<Sweep>& flesh, const Build& b, const Places& p, const Bones& bones) {
  const double r = 0.108 * b.fingers_thick;
  flesh.push_back(
      cone(p.thumb[0], p.thumb[1], 0.19 * b.thickness, 0.13 * b.fingers_thick, bones.thumb[0], 0.12));
  flesh.back().bones = {{bones.hand}, {bones.thumb[0], 0.25, 0.25}, {bones.thumb[1], 1.0, 0.16}};
  const Vec3 along = (p.thumb[3] - p.thumb[1]).normalized(), end = p.thumb[3] - r * along;
  const Vec3 nail(-0.35, 0.25, -1);  // the thumb is turned a little across the palm
  const double length = (end - p.thumb[1]).norm(), at = (p.thumb[2] - p.thumb[1]).norm() / length;
  flesh.push_back({.from = p.thumb[1],
                   .to = end,
                   .front = -nail,
                   .sections = {{0, 1.15 * r, 1.1 * r, 1.2 * r},
                                {0.5 * at, 1.0 * r, 1.0 * r, 1.0 * r},
                                {at, 1.05 * r, 0.95 * r, 1.0 * r},
                                {0.5 + 0.5 * at, 1.0 * r, 0.98 * r, 0.80 * r},
                                {1, 0.86 * r, 0.88 * r, 0.62 * r}},
                   .start_cap = r,
                   .end_cap = r,
                   .bones = {{bones.thumb[0]}, {bones.thumb[1], 0.0, 0.16}, {bones.thumb[2], at, 0.12}},
                   .blend = 0.08,
                   .detail = 0.75});
}

std::vector<Anchor> anchors(const Places& p) {
  const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
  std::vector<Anchor> all{{"thumbTip", p.thumb[2], p.thumb[3] - p.thumb[2]},
                          {"thumbKnuckle", p.thumb[1], Vec3(0.5, -0.35, -0.5)}};
  const char* names[4] = {"index", "middle", "ring", "little"};
  for (int i = 0; i < 4; ++i) {
    all.push_back({std::string(names[i]) + "Tip", p.finger[i][2], p.finger[i][3] - p.finger[i][2]});
    all.push_back({std::string(names[i]) + "Knuckle", p.finger[i][0], -z});
  }
  all.push_back({"palm", Vec3(0.02, 0.48, 0), z});
  all.push_back({"backOfHand", Vec3(0, 0.48, 0), -z});
  all.push_back({"wristFront", p.wrist, z});
  all.push_back({"wristBack", p.wrist, -z});
  all.push_back({"wristThumbSide", p.wrist, x});
  all.push_back({"wristLittleSide", p.wrist, -x});
  return all;
}

std::vector<Freedom> freedoms(const Bones& b, const Places& p) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  std::vector<Freedom> all{{b.hand, x, -30, 35},
                           {b.hand, z, -12, 15},
                           {b.hand, y, -15, 15},
                           {b.thumb[0], z, -8, 16},
                           {b.thumb[0], y, -30, 10},
                           {b.thumb[1], Vec3(0.45, -0.2, 1), -5, 30},
                           {b.thumb[2], Vec3(0.45, -0.2, 1), -10, 45}};
  for (int i = 0; i < 4; ++i) {
    const Vec3 flex = (p.finger[i][3] - p.finger[i][0]).cross(z);
    all.push_back({b.finger[i][1], flex, -5, 75});
    all.push_back({b.finger[i][2], flex, 0, 50});
    all.push_back({b.finger[i][0], flex, -22, 62});
    all.push_back({b.finger[i][0], z, -3, 3});
  }
  return all;
}

}  // namespace

Design design_hand(Random& random) {
  const Build build{random.uniform(0.9, 1.1),  random.uniform(0.88, 1.18), random.uniform(0.88, 1.12),
                    random.uniform(0.9, 1.02), random.typical(0.9, 1.12),  random.uniform(0.8, 1.2)};
  const Places places = place(build, random);
  const Bones bones = skeleton(places);
  std::vector<Sweep> flesh;
  add_palm(flesh, build, places, bones);
  add_thumb(flesh, build, places, bones);
  add_fingers(flesh, places, bones);
  return {bones.all,       Body(flesh, bones.all.mirror, random_asymmetry(random, 0.008)),
          anchors(places), freedoms(bones, places),
          0.024,           0.1 * random.typical(0.9, 1.12)};
}

}  // namespace creatures
