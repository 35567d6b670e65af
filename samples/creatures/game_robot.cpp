// Robots and block figures: boxes or capsules, each rigid on one bone.
#include <algorithm>
#include <cmath>

#include "game_humanoid.h"

namespace creatures::game {
namespace {

struct Look {
  bool boxes, joints, limbs_whole;
  double gap, thick, flare;
  Tube how;
};

Look random_look(Workshop& shop) {
  Look l;
  const bool blocky = shop.plan.style.kind == Kind::blocky;
  l.boxes = blocky || shop.chance(0.55);
  l.joints = !blocky && shop.chance(0.7);
  l.limbs_whole = blocky && shop.chance(0.6);
  l.gap = blocky ? 0 : shop.random.uniform(-0.02, 0.08);
  l.thick = shop.random.uniform(0.8, 1.4);
  l.flare = blocky ? 1 : shop.random.uniform(0.8, 1.5);
  const int edges = shop.chance(0.5) ? 8 : 4;
  l.how = l.boxes
              ? Tube{.sides = edges, .rings = 1, .caps = edges == 4 ? 0 : 2, .square = edges == 4 ? 1 : 0.75}
              : Tube{.sides = std::max(6, shop.plan.style.sides), .rings = 2, .caps = 3};
  return l;
}

// A block from one joint to the next. Half widths across and in depth at both ends.
Mesh block(const Look& l, const Vec3& from, const Vec3& to, double side, double deep, double end = 1) {
  const double gap = l.gap * (to - from).norm();
  Sweep s = cone(from, to, 1, 1, 0, 0);
  const Vec3 along = (to - from).normalized();
  s.from += gap * along;
  s.to -= gap * along;
  s.front = std::abs(along.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitY();
  s.sections = {{0, side, deep, deep}, {1, end * side, end * deep, end * deep}};
  s.start_cap = s.end_cap = l.boxes ? 0.15 * std::min(side, deep) : 0.7 * std::min(side, deep);
  return tube(s, l.how);
}

void add_ball(Workshop& shop, const Look& l, const std::string& name, const Vec3& at, double radius, int bone,
              bool paired) {
  Tube how = l.how;
  how.sides = std::max(6, how.sides);
  how.caps = 2;
  how.square = 0;
  shop.add_rigid(name, tube(ellipsoid(at, Vec3::Constant(radius), 0, 0), how), bone, paired);
}

void add_trunk(Workshop& shop, const Look& l) {
  const Places& p = shop.plan.at;
  const Bones& b = shop.plan.bones;
  const double w = p.width, d = 0.1 * w * shop.plan.style.depth * l.thick,
               waist = shop.random.uniform(0.55, 1);
  const double hip = std::max(0.14 * w, p.hip.x() + 0.04 * w),
               chest = std::max(0.1 * w, p.shoulder.x() - (l.boxes ? 0.02 : 0.05) * w);
  const Vec3 low(0, p.hip.y() - 0.04 * w, 0), neck(0, p.neck.y(), -0.01);
  const auto add = [&](const std::string& name, const Vec3& from, const Vec3& to, double side, double deep,
                       double end,
                       int bone) { shop.add_rigid(name, block(l, from, to, side, deep, end), bone, false); };
  const double whole = l.boxes && !l.joints ? 1 : waist;
  add("pelvis", low, p.spine, hip, d, whole, b.hips);
  add("waist", p.spine, p.chest, whole * hip, 0.9 * d * (0.3 + 0.7 * whole), 1, b.spine);
  add("ribs", p.chest, p.upper_chest, whole * chest, d, 1 / std::sqrt(whole), b.chest);
  add("chest", p.upper_chest, neck, chest, 1.15 * d, l.boxes ? 1 : 0.7, b.upper_chest);
  add("neck", p.neck - Vec3(0, 0.02, 0), p.head + Vec3(0, 0.02, 0), 0.05 * w, 0.05 * w, 1, b.neck);
  add("shoulderBlock", p.clavicle, p.shoulder, 0.045 * w, 0.06 * w, 1, b.shoulder);
  shop.add_rigid("shoulderBlock", mirrored(shop.parts.back().mesh), b.all.mirror[b.shoulder], false);
}

void add_limbs(Workshop& shop, const Look& l) {
  const Places& p = shop.plan.at;
  const Bones& b = shop.plan.bones;
  const double t = 0.045 * p.width * shop.plan.style.limbs * l.thick,
               leg = std::min(1.5 * t, 0.95 * p.hip.x()), f = l.flare;
  const double hand = (p.fingertip - p.wrist).norm();
  shop.add_rigid("upperArm", block(l, p.shoulder, p.elbow, t, t, 1), b.upper_arm, true);
  shop.add_rigid("lowerArm", block(l, p.elbow, p.wrist, t, t, f), b.lower_arm, true);
  shop.add_rigid("hand", block(l, p.wrist, p.fingertip, 0.2 * hand + 0.4 * t, 0.3 * hand + 0.4 * t, 0.9),
                 b.hand, true);
  if (shop.chance(0.5)) {
    const Vec3 at = p.wrist + 0.3 * hand * p.forearm + 0.3 * hand * p.thumb;
    shop.add_rigid("thumb", block(l, at, at + 0.35 * hand * (p.thumb + p.forearm), 0.1 * hand, 0.1 * hand),
                   b.hand, true);
  }
  const Vec3 ankle = p.ankle + Vec3(0, 0.2 * p.sole, 0);
  shop.add_rigid("upperLeg", block(l, p.hip, p.knee, leg, leg, 1), b.upper_leg, true);
  shop.add_rigid("lowerLeg", block(l, p.knee, ankle, leg, leg, l.limbs_whole ? 1 : std::min(f, 1.3)),
                 b.lower_leg, true);
  const double sole = 0.5 * p.sole, wide = std::max(0.045, 0.9 * leg),
               feet = (p.toe_tip - p.toes).norm() / 0.075;
  const Vec3 heel(p.ankle.x(), sole, p.ankle.z() - 0.04 * feet), ball(p.ankle.x(), sole, p.toes.z()),
      tip(p.ankle.x(), sole, p.toe_tip.z());
  Look flat = l;
  flat.gap = 0;
  const auto foot = [&](const Vec3& from, const Vec3& to) {
    Mesh mesh = block(flat, from, to, wide, sole);
    for (Vec3& q : mesh.positions) q.y() = std::max(q.y(), 0.0);
    return mesh;
  };
  shop.add_rigid("foot", foot(heel, ball), b.foot, true);
  shop.add_rigid("toes", foot(ball, tip), b.toes, true);
  if (!l.joints) return;
  add_ball(shop, l, "shoulderBall", p.shoulder, 1.25 * t, b.upper_arm, true);
  add_ball(shop, l, "elbowBall", p.elbow, 1.1 * t, b.lower_arm, true);
  add_ball(shop, l, "wristBall", p.wrist, 0.8 * t, b.hand, true);
  add_ball(shop, l, "hipBall", p.hip, 1.1 * leg, b.upper_leg, true);
  add_ball(shop, l, "kneeBall", p.knee, 1.1 * leg, b.lower_leg, true);
}

void add_robot_head(Workshop& shop, const Look& l) {
  const Places& p = shop.plan.at;
  const Bones& b = shop.plan.bones;
  const Vec3 r = p.skull_radii, low = p.skull - Vec3(0, 1.45 * r.y(), 0);
  const double side = 1.25 * r.x(), deep = 1.05 * r.z();
  Look solid = l;
  solid.gap = 0;
  const Vec3 lift(0, l.boxes ? 0 : 0.5 * std::min(side, deep), 0);
  shop.add_rigid("head",
                 block(solid, low + lift, p.skull + Vec3(0, 0.95 * r.y(), 0) - lift, side, deep,
                       shop.random.uniform(0.85, 1.1)),
                 b.head, false);
  const double size = shop.random.uniform(0.15, 0.3);
  const Vec3 eye(0.45 * side, p.skull.y() - 0.2 * r.y(), p.skull.z() + 0.95 * deep);
  if (shop.chance(0.7))
    shop.add_rigid("eye",
                   tube(ellipsoid(eye, size * Vec3(side, r.y(), 0.5 * deep), 0, 0), {.sides = 6, .caps = 2}),
                   b.head, true);
  if (shop.chance(0.4)) {
    const Vec3 from(shop.chance(0.5) ? 0.0 : 0.7 * side, p.skull.y() + 0.8 * r.y(), p.skull.z());
    Mesh mast = tube(cone(from, from + Vec3(0, 0.8 * r.y(), 0), 0.06 * side, 0.04 * side, 0, 0),
                     {.sides = 5, .rings = 1, .caps = 1});
    append(mast, tube(ellipsoid(from + Vec3(0, 0.85 * r.y(), 0), Vec3::Constant(0.13 * side), 0, 0),
                      {.sides = 6, .caps = 2}));
    shop.add_rigid("antenna", mast, b.head, from.x() > 0);
  }
  if (shop.chance(0.35))
    shop.add_rigid("earPhone",
                   tube(ellipsoid(p.skull + Vec3(side, -0.2 * r.y(), 0),
                                  {0.25 * side, 0.35 * r.y(), 0.35 * r.y()}, 0, 0),
                        {.sides = 8, .caps = 2}),
                   b.head, true);
}

}  // namespace

void make_robot(Workshop& shop) {
  const Look look = random_look(shop);
  add_trunk(shop, look);
  add_limbs(shop, look);
  add_robot_head(shop, look);
}

}  // namespace creatures::game
