// What a game humanoid wears over its clothes: armour, packs, capes, tails, things in its hands.
#include <algorithm>
#include <cmath>

#include "game_humanoid.h"

namespace creatures::game {
namespace {

// A box with its axes along `right`, `up` and their cross product.
Mesh slab(const Vec3& at, const Vec3& right, const Vec3& up, const Vec3& half, double taper = 1) {
  const Vec3 u = up.normalized();
  Sweep s = cone(at - half.y() * u, at + half.y() * u, 1, 1, 0, 0);
  s.front = right.cross(u);
  s.sections = {{0, half.x(), half.z(), half.z()}, {1, taper * half.x(), half.z(), half.z()}};
  return tube(s, {.sides = 4, .rings = 1, .caps = 0, .square = 1});
}

// The part of a ball on the side of `way`.
Mesh shell(const Workshop& shop, const Vec3& at, const Vec3& radii, const Vec3& way, double from) {
  Tube how = shop.usual();
  how.caps = std::max(2, how.sides / 3);
  const Mesh ball = tube(ellipsoid(at, radii, 0, 0), how);
  return clip(ball,
              [=](const Vec3& q) { return from - (q - at).cwiseQuotient(radii).dot(way.normalized()); });
}

void add_shoulder_plates(Workshop& shop) {
  const Places& p = shop.plan.at;
  const double size = shop.random.uniform(0.075, 0.12) * p.width;
  const Vec3 way(0.6, 0.8, 0), at = p.shoulder + Vec3(0.01, -0.01, 0);
  Mesh plate =
      shop.chance(0.6)
          ? shell(shop, at, {size, 0.9 * size, size}, way, shop.random.uniform(-0.2, 0.3))
          : slab(at + 0.5 * size * way, {0.8, -0.6, 0}, way, {0.9 * size, 0.3 * size, 0.9 * size}, 0.7);
  if (shop.chance(0.25)) {
    Sweep spike = cone(at + 0.6 * size * way, at + 2 * size * way, 0.3 * size, 0.02 * size, 0, 0);
    append(plate, tube(spike, {.sides = 6, .rings = 1, .caps = 1}));
  }
  shop.add_rigid("shoulderPlate", plate,
                 shop.chance(0.5) ? shop.plan.bones.upper_arm : shop.plan.bones.shoulder, true);
}

void add_chest_plate(Workshop& shop) {
  Tube how = shop.usual();
  how.from = shop.random.uniform(0.35, 0.55);
  how.to = shop.random.uniform(0.85, 0.95);
  how.open_start = how.open_end = shop.chance(0.7);
  how.caps = 1;
  const Mesh plate = tube(inflated(shop.flesh.torso[0], shop.random.uniform(0.022, 0.04)), how);
  shop.add_rigid("chestPlate", plate, shop.chance(0.6) ? shop.plan.bones.upper_chest : shop.plan.bones.chest,
                 false);
}

void add_limb_armour(Workshop& shop) {
  const Bones& b = shop.plan.bones;
  const Places& p = shop.plan.at;
  const auto guard = [&](const std::string& name, const Sweep& limb, int bone, double from, double to) {
    Tube how = shop.usual();
    how.rings = 2;
    how.from = from;
    how.to = to;
    how.open_start = how.open_end = shop.chance(0.6);
    how.caps = 0;
    shop.add_rigid(name, tube(inflated(limb, 0.016 * p.width), how), bone, true);
  };
  if (shop.chance(0.5)) guard("bracer", shop.flesh.arms[1], b.lower_arm, 0.3, 0.9);
  if (shop.chance(0.5)) guard("greave", shop.flesh.legs[0], b.lower_leg, 0.15, 0.8);
  if (shop.chance(0.4)) {
    const double size = 0.062 * p.width * shop.plan.style.limbs;
    shop.add_rigid("kneePad", shell(shop, p.knee, {size, 1.1 * size, 1.15 * size}, {0, 0, 1}, 0.3),
                   b.lower_leg, true);
  }
  if (shop.chance(0.3)) {
    const Vec3 at = p.hip + Vec3(0.09 * p.width, -0.03, 0);
    shop.add_rigid("tasset", slab(at, {0, 0, 1}, {0.25, -1, 0}, {0.07 * p.width, 0.09 * p.width, 0.012}),
                   b.upper_leg, true);
  }
}

void add_pack(Workshop& shop) {
  const Places& p = shop.plan.at;
  const double w = p.width * shop.random.uniform(0.8, 1.4), deep = 0.08 * w;
  const Vec3 at(0, 0.5 * (p.chest.y() + p.upper_chest.y()) + 0.02,
                -0.1 * p.width * shop.plan.style.depth - 0.8 * deep);
  const int bone = shop.chance(0.6) ? shop.plan.bones.upper_chest : shop.plan.bones.chest;
  Sweep s = cone(at - Vec3(0, 0.12 * w, 0), at + Vec3(0, 0.12 * w, 0), 1, 1, bone, 0);
  s.front = Vec3::UnitZ();
  s.sections = {{0, 0.13 * w, deep, deep}, {1, 0.11 * w, deep, 0.8 * deep}};
  s.start_cap = s.end_cap = 0.03 * w;
  Tube how = shop.usual();
  how.sides = shop.chance(0.5) ? 4 : 8;
  how.square = shop.random.uniform(0.5, 1);
  how.caps = 2;
  Mesh pack = tube(s, how);
  if (shop.chance(0.4)) {
    Sweep roll = cone(at + Vec3(-0.15 * w, 0.18 * w, 0), at + Vec3(0.15 * w, 0.18 * w, 0), 0.05 * w, 0.05 * w,
                      bone, 0);
    append(pack, tube(roll, {.sides = 7, .rings = 1, .caps = 1}));
  }
  shop.add_rigid("pack", pack, bone, false);
}

void add_cape(Workshop& shop) {
  const Places& p = shop.plan.at;
  const Bones& b = shop.plan.bones;
  const double top = p.neck.y() - 0.03, bottom = shop.random.uniform(0.03, 0.8 * p.hip.y());
  const double wide = std::max(0.13, 0.9 * p.shoulder.x()), flare = shop.random.uniform(1, 1.9);
  const double back = 0.07 * p.width * shop.plan.style.depth + 0.03, away = shop.random.uniform(0.02, 0.3);
  const int columns = 3 + shop.plan.style.sides / 3, rows = 3 + shop.plan.style.sides / 2;
  const double folds = shop.random.uniform(0, 0.025), count = shop.random.uniform(2, 5);
  const auto place = [&](double u, double v) {
    const double a = 2 * u - 1, half = wide * (1 + (flare - 1) * v);
    const double round = 0.5 * wide * (1 - v) * a * a;
    const double fold = folds * v * std::cos(count * EIGEN_PI * a);
    return Vec3(-a * half, top - v * (top - bottom),
                -back - 0.05 * std::min(4 * v, 1.0) - away * v * v + round + fold);
  };
  Mesh cape = sheet(columns, rows, place);
  if (shop.chance(0.35)) {  // seen from both sides: the same faces again, turned
    Mesh inside = cape;
    for (Triangle& t : inside.triangles) std::swap(t[1], t[2]);
    append(cape, inside);
  }
  shop.add("cape", cape, ridden(shop.body, {b.upper_chest, b.chest, b.spine, b.hips}), 2);
}

void add_tail(Workshop& shop) {
  const Places& p = shop.plan.at;
  const double size = shop.random.uniform(0.15, 0.5), thick = shop.random.uniform(0.02, 0.06);
  const Vec3 from(0, p.hip.y() + 0.02, -0.08 * p.width * shop.plan.style.depth);
  const Vec3 middle = from + size * Vec3(0, shop.random.uniform(-0.7, 0.3), -0.8);
  const Vec3 to = middle + size * Vec3(0, shop.random.uniform(-0.3, 0.9), -0.4);
  Tube how = shop.usual();
  Mesh tail = tube(cone(from, middle, thick, thick, 0, 0), how);
  append(tail, tube(cone(middle, to, thick * shop.random.uniform(0.9, 1.8), 0.3 * thick, 0, 0), how));
  shop.add_rigid("tail", tail, shop.plan.bones.hips, false);
}

void add_wings(Workshop& shop) {
  const Places& p = shop.plan.at;
  const Vec3 root(0.04, p.upper_chest.y(), -0.11 * p.width);
  const double size = shop.random.uniform(0.3, 0.8), up = shop.random.uniform(-0.1, 0.6);
  const Mesh wing = sheet(4, 2, [&](double u, double v) {
    return Vec3(root + size * Vec3(u, up * u - v * (0.25 + 0.5 * u * (1 - 0.4 * u)), -0.25 * u));
  });
  shop.add_rigid("wing", wing, shop.plan.bones.upper_chest, true);
}

void add_held(Workshop& shop) {
  const Places& p = shop.plan.at;
  const double size = (p.fingertip - p.wrist).norm();
  const Vec3 grip = p.wrist + 0.5 * size * p.forearm + 0.15 * size * p.palm;
  const Vec3 along = p.thumb, across = along.cross(p.forearm).normalized();
  Mesh thing;
  const double kind = shop.random.uniform(0, 1), long_ = shop.random.uniform(0.3, 0.9);
  if (kind < 0.5) {  // a blade
    thing = slab(grip + 0.5 * long_ * along, across, along, {0.008, 0.5 * long_, 0.03}, 0.8);
    append(thing, slab(grip + 0.05 * along, across, along, {0.015, 0.012, 0.08}));
    append(thing, slab(grip - 0.05 * along, across, along, {0.014, 0.09, 0.014}));
  } else if (kind < 0.75) {  // a staff
    thing = tube(cone(grip - long_ * along, grip + long_ * along, 0.016, 0.016, 0, 0),
                 {.sides = 6, .rings = 1, .caps = 1});
    append(thing, tube(ellipsoid(grip + long_ * along, {0.05, 0.05, 0.05}, 0, 0), {.sides = 6, .caps = 2}));
  } else {  // a shield on the forearm
    thing = slab(0.5 * (p.elbow + p.wrist) - 0.06 * p.palm, p.thumb, p.forearm, {0.18, 0.2, 0.012});
  }
  // In one hand: the left one's, or its mirror image.
  const int left = kind < 0.75 ? shop.plan.bones.hand : shop.plan.bones.lower_arm;
  const bool right = shop.chance(0.6);
  shop.add_rigid("held", right ? mirrored(thing) : thing, right ? shop.plan.bones.all.mirror[left] : left,
                 false);
}

}  // namespace

void equip(Workshop& shop) {
  const bool armoured = shop.chance(0.24);
  if (armoured || shop.chance(0.05)) add_shoulder_plates(shop);
  if (armoured && shop.chance(0.6)) add_chest_plate(shop);
  if (armoured) add_limb_armour(shop);
  if (shop.chance(0.14)) add_pack(shop);
  if (shop.chance(0.15)) add_cape(shop);
  if (shop.chance(shop.plan.style.kind == Kind::mascot ? 0.4 : 0.05)) add_tail(shop);
  if (shop.chance(0.02)) add_wings(shop);
  if (shop.chance(0.12)) add_held(shop);
}

}  // namespace creatures::game
