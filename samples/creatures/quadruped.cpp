// Four-legged animals with paws, ears and a tail, standing.
#include "stock_bones.h"

namespace creatures {
namespace {

// Relative to an average animal.
struct Build {
  double legs, length, barrel, limbs, neck, neck_up, head, muzzle, ears, tail, chest;
};

Build random_build(Random& random) {
  Build b;
  b.legs = random.typical(0.82, 1.15);
  b.length = random.typical(0.88, 1.12);
  b.barrel = random.uniform(0.84, 1.14);
  b.limbs = random.uniform(0.85, 1.15);
  b.neck = random.typical(0.8, 1.25);
  b.neck_up = random.uniform(35, 60) * EIGEN_PI / 180;
  b.head = random.typical(0.9, 1.15);
  b.muzzle = random.uniform(0.8, 1.25);
  b.ears = random.uniform(0.75, 1.3);
  b.tail = random.uniform(0.8, 1.25);
  b.chest = random.typical(0.9, 1.12);
  return b;
}

using Places = QuadrupedPlaces;
using Bones = QuadrupedBones;

Places place(const Build& b) {
  Places p;
  const double y = 0.57 * b.legs, n = b.length;
  p.hips = {0, y + 0.05, -0.36 * n};
  p.spine = {0, y + 0.06, -0.13 * n};
  p.chest = {0, y + 0.06, 0.1 * n};
  p.neck = {0, y + 0.11, 0.3 * n};
  p.head = p.neck + 0.26 * b.neck * Vec3(0, std::sin(b.neck_up), std::cos(b.neck_up));
  p.nose = p.head + b.head * Vec3(0, -0.055, 0.14 + 0.11 * b.muzzle);
  p.tail[0] = p.hips + Vec3(0, 0.035, -0.12);
  for (int i = 0; i < 3; ++i)
    p.tail[i + 1] =
        p.tail[i] + b.tail * (0.17 - 0.01 * i) * Vec3(0, -0.35 - 0.3 * i, -1 + 0.28 * i).normalized();
  p.shoulder = {0.085, y + 0.01, 0.25 * n};
  p.elbow = {0.098, 0.64 * y, 0.25 * n - 0.07};
  p.wrist = {0.1, 0.3 * y, 0.25 * n - 0.045};
  p.front_paw = {0.1, 0.045, 0.25 * n - 0.05};
  p.front_toe = p.front_paw + Vec3(0, -0.015, 0.085);
  p.hip = {0.085, y, -0.36 * n};
  p.knee = {0.105, 0.62 * y, -0.36 * n + 0.07};
  p.hock = {0.1, 0.33 * y, -0.36 * n - 0.1};
  p.hind_paw = {0.1, 0.045, -0.36 * n - 0.065};
  p.hind_toe = p.hind_paw + Vec3(0, -0.015, 0.09);
  p.ear = p.head + b.head * Vec3(0.048, 0.055, -0.02);
  p.ear_tip = p.ear + b.ears * Vec3(0.035, 0.11, -0.012);
  return p;
}

void add_torso(std::vector<Sweep>& flesh, const Build& b, const Places& p, const Bones& bones) {
  const double r = b.barrel, c = b.barrel * b.chest;
  // Along z; `front` is up, so the back half of a section is the belly.
  flesh.push_back({.from = p.hips + Vec3(0, 0, -0.07),
                   .to = p.neck + Vec3(0, -0.06, -0.02),
                   .front = Vec3::UnitY(),
                   .sections = {{0.00, 0.085 * r, 0.080 * r, 0.085 * r},
                                {0.15, 0.108 * r, 0.092 * r, 0.105 * r},
                                {0.40, 0.102 * r, 0.082 * r, 0.115 * r},
                                {0.65, 0.122 * c, 0.088 * r, 0.165 * c},
                                {0.85, 0.115 * c, 0.105 * r, 0.155 * c},
                                {1.00, 0.085 * c, 0.085 * r, 0.105 * c}},
                   .start_cap = 0.06,
                   .end_cap = 0.07,
                   .bones = {{bones.hips}, {bones.spine, 0.4, 0.16}, {bones.chest, 0.68, 0.16}},
                   .blend = 0.06});
  flesh.push_back({.from = p.neck + Vec3(0, -0.06, -0.05),
                   .to = p.head,
                   .front = Vec3::UnitY(),
                   .sections = {{0, 0.080 * c, 0.085 * r, 0.115 * c},
                                {0.5, 0.062 * c, 0.068 * r, 0.080 * c},
                                {1, 0.050, 0.055, 0.060}},
                   .start_cap = 0.06,
                   .end_cap = 0.05,
                   .bones = {{bones.chest}, {bones.neck, 0.28, 0.12}, {bones.head, 0.92, 0.08}},
                   .blend = 0.07,
                   .detail = 0.85});
  for (int i = 0; i < 3; ++i) {
    Sweep tail = cone(p.tail[i], p.tail[i + 1], 0.032 - 0.005 * i, 0.027 - 0.005 * i, bones.tail[i], 0.02);
    tail.bones = {{i == 0 ? bones.hips : bones.tail[i - 1]}, {bones.tail[i], 0.0, 0.06}};
    tail.detail = 0.65;
    if (i == 0) tail.blend = 0.05;
    flesh.push_back(tail);
  }
}

void add_head(std::vector<Sweep>& flesh, const Build& b, const Places& p, const Bones& bones) {
  const double h = b.head;
  const Vec3 along = (p.nose - p.head).normalized(), up = along.cross(Vec3::UnitX()).normalized() * -1;
  const Vec3 brow = p.head + 0.09 * h * along;
  flesh.push_back({.from = p.head,
                   .to = p.nose - 0.03 * along,
                   .front = -up.y() > 0 ? Vec3(-up) : up,
                   .sections = {{0.00, 0.066 * h, 0.062 * h, 0.058 * h},
                                {0.30, 0.068 * h, 0.064 * h, 0.062 * h, 0.006},
                                {0.52, 0.048 * h, 0.042 * h, 0.056 * h, -0.004},
                                {0.75, 0.038 * h, 0.030 * h, 0.046 * h, -0.008},
                                {1.00, 0.034 * h, 0.028 * h, 0.034 * h, -0.008}},
                   .start_cap = 0.06 * h,
                   .end_cap = 0.03,
                   .bones = {{bones.head}},
                   .blend = 0.04,
                   .detail = 0.65});
  const auto ball = [&](const Vec3& at, const Vec3& radii, double blend, bool carve, bool paired) {
    Sweep s = ellipsoid(at, h * radii, bones.head, blend);
    s.detail = 0.6;
    s.carve = carve;
    s.paired = paired;
    flesh.push_back(s);
  };
  ball(p.nose + Vec3(0, 0.012, -0.018), {0.019, 0.015, 0.016}, 0.012, false, false);
  ball(brow + h * Vec3(0.038, 0.043, 0.005), {0.022, 0.013, 0.028}, 0.035, false, true);
  ball(brow + h * Vec3(0.056, 0.02, 0.035), {0.012, 0.013, 0.018}, 0.016, true, true);
  flesh.push_back(
      {.from = p.ear,
       .to = p.ear_tip,
       .front = Vec3(0.5, 0, 1),
       .sections = {{0, 0.036 * h, 0.020, 0.024}, {0.45, 0.036 * h, 0.014, 0.020}, {1, 0.014, 0.010, 0.011}},
       .start_cap = 0.02,
       .end_cap = 0.012,
       .bones = {{bones.head}, {bones.ear, 0.1, 0.05}},
       .blend = 0.02,
       .detail = 0.6,
       .paired = true});
}

// From the paw up to the joint with the trunk, through the joints between; sections lie flat, and their centres
// follow the bones.
void add_leg(std::vector<Sweep>& flesh, const std::array<Vec3, 4>& joints, const std::array<int, 4>& bones,
             std::vector<Section> sections, double trunk_cap, int trunk) {
  const double height = joints[3].y() - joints[0].y();
  const auto at = [&](int i) { return (joints[i].y() - joints[0].y()) / height; };
  flesh.push_back({.from = joints[0],
                   .to = Vec3(joints[0].x(), joints[3].y(), joints[0].z()),
                   .front = Vec3::UnitZ(),
                   .sections = std::move(sections),
                   .start_cap = 0.025,
                   .end_cap = trunk_cap,
                   .bones = {{bones[0]},
                             {bones[1], 0.04, 0.04},
                             {bones[2], at(1), 0.05},
                             {bones[3], at(2), 0.08},
                             {trunk, 1.05, 0.16}},
                   .blend = 0.07,
                   .detail = 0.75,
                   .paired = true,
                   .pair_blend = 0.02});
}

void add_legs(std::vector<Sweep>& flesh, const Build& b, const Places& p, const Bones& bones) {
  const double w = b.limbs;
  const auto front = [&](const Vec3& q) { return q.z() - p.front_paw.z(); };
  const auto hind = [&](const Vec3& q) { return q.z() - p.hind_paw.z(); };
  const auto up = [&](const Vec3& q, const Vec3& paw, const Vec3& top) {
    return (q.y() - paw.y()) / (top.y() - paw.y());
  };
  const double wrist = up(p.wrist, p.front_paw, p.shoulder), elbow = up(p.elbow, p.front_paw, p.shoulder);
  add_leg(flesh, {p.front_paw, p.wrist, p.elbow, p.shoulder},
          {bones.front_paw, bones.front_foot, bones.front_lower, bones.front_upper},
          {{0.0, 0.028 * w, 0.028 * w, 0.028 * w, 0.0},
           {0.5 * wrist, 0.025 * w, 0.027 * w, 0.027 * w, 0.0},
           {wrist, 0.029 * w, 0.031 * w, 0.030 * w, front(p.wrist)},
           {0.8 * elbow + 0.2 * wrist, 0.036 * w, 0.040 * w, 0.043 * w, 0.6 * front(p.elbow)},
           {elbow, 0.041 * w, 0.050 * w, 0.050 * w, front(p.elbow) + 0.012},
           {0.5 + 0.5 * elbow, 0.050 * w, 0.070 * w, 0.066 * w, 0.45 * front(p.shoulder)},
           {1.0, 0.048 * w, 0.078 * w, 0.078 * w, front(p.shoulder) - 0.03}},
          0.11, bones.chest);
  const double hock = up(p.hock, p.hind_paw, p.hip), knee = up(p.knee, p.hind_paw, p.hip);
  add_leg(
      flesh, {p.hind_paw, p.hock, p.knee, p.hip},
      {bones.hind_paw, bones.hind_foot, bones.hind_lower, bones.hind_upper},
      {{0.0, 0.028 * w, 0.030 * w, 0.028 * w, 0.0},
       {0.5 * hock, 0.024 * w, 0.027 * w, 0.027 * w, 0.6 * hind(p.hock)},
       {hock, 0.028 * w, 0.036 * w, 0.040 * w, hind(p.hock) + 0.005},
       {0.5 * (hock + knee), 0.036 * w, 0.050 * w, 0.050 * w, 0.5 * (hind(p.hock) + hind(p.knee)) - 0.005},
       {knee, 0.050 * w, 0.066 * w, 0.080 * w, hind(p.knee) - 0.02},
       {0.5 + 0.5 * knee, 0.062 * w, 0.095 * w, 0.095 * w, 0.5 * (hind(p.knee) + hind(p.hip))},
       {1.0, 0.066 * w, 0.105 * w, 0.095 * w, hind(p.hip)}},
      0.09, bones.hips);
  for (const auto& [paw, toe, bone] : {std::tuple{p.front_paw, p.front_toe, bones.front_paw},
                                       std::tuple{p.hind_paw, p.hind_toe, bones.hind_paw}}) {
    flesh.push_back({.from = paw + Vec3(0, -0.014, -0.008),
                     .to = toe + Vec3(0, 0, -0.03),
                     .front = Vec3::UnitY(),
                     .sections = {{0, 0.032 * w, 0.034 * w, 0.028}, {1, 0.040 * w, 0.028 * w, 0.026}},
                     .start_cap = 0.028,
                     .end_cap = 0.03,
                     .bones = {{bone}},
                     .blend = 0.025,
                     .detail = 0.6,
                     .paired = true});
  }
}

std::vector<Anchor> anchors(const Places& p) {
  const Vec3 up = Vec3::UnitY(), down = -up, front = Vec3::UnitZ(), left = Vec3::UnitX();
  return {{"nose", p.nose - Vec3(0, -0.01, 0.03), p.nose - p.head + 0.1 * up},
          {"crown", p.head, up},
          {"withers", p.neck + Vec3(0, -0.05, -0.08), up},
          {"croup", p.hips, up},
          {"chest", p.neck + Vec3(0, -0.08, -0.05), front - 0.35 * up},
          {"belly", p.spine + Vec3(0, 0, 0.03), down},
          {"tailTip", p.tail[2], p.tail[3] - p.tail[2]},
          {"earTip", 0.7 * p.ear + 0.3 * p.ear_tip, p.ear_tip - p.ear, true},
          {"shoulder", p.shoulder, left, true},
          {"elbow", p.elbow + Vec3(0, 0.01, 0.01), -front, true},
          {"frontToe", p.front_toe + Vec3(0, -0.002, -0.04), front, true},
          {"knee", p.knee + Vec3(0, 0, -0.02), front, true},
          {"hock", p.hock, -front, true},
          {"hindToe", p.hind_toe + Vec3(0, -0.002, -0.04), front, true}};
}

std::vector<Freedom> freedoms(const Bones& b) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  return {{b.spine, y, -12, 12},
          {b.spine, x, -8, 10},
          {b.chest, y, -12, 12},
          {b.neck, x, -15, 40},
          {b.neck, y, -28, 28},
          {b.head, x, -20, 20},
          {b.head, y, -25, 25},
          {b.head, z, -12, 12},
          {b.tail[0], y, -30, 30},
          {b.tail[0], x, -30, 40},
          {b.tail[1], y, -25, 25},
          {b.tail[1], x, -20, 20},
          {b.tail[2], y, -25, 25},
          {b.tail[2], x, -20, 20},
          {b.ear, z, -20, 12, true},
          {b.ear, x, -20, 20, true},
          {b.front_upper, x, -38, 30, true},
          {b.front_upper, z, -4, 10, true},
          {b.front_lower, x, -55, 5, true},
          {b.front_foot, x, -5, 60, true},
          {b.front_paw, x, -20, 25, true},
          {b.hind_upper, x, -35, 30, true},
          {b.hind_upper, z, -4, 10, true},
          {b.hind_lower, x, -15, 45, true},
          {b.hind_foot, x, -45, 15, true},
          {b.hind_paw, x, -20, 25, true}};
}

}  // namespace

Design design_quadruped(Random& random) {
  const Build build = random_build(random);
  const Places places = place(build);
  const Bones bones = quadruped_skeleton(places);
  std::vector<Sweep> flesh;
  add_torso(flesh, build, places, bones);
  add_legs(flesh, build, places, bones);
  add_head(flesh, build, places, bones);
  return {bones.all,       Body(flesh, bones.all.mirror, random_asymmetry(random, 0.0012)),
          anchors(places), freedoms(bones),
          0.0115,          random.typical(0.8, 1.25)};
}

}  // namespace creatures
