// A game quadruped from its plan: flesh, what is separate on animals, and one character out of all parts.
#include "game_quadruped.h"

#include <algorithm>
#include <cmath>

#include "game.h"

namespace creatures::game {
namespace beast {
namespace {

void add_trunk(Flesh& flesh, const Plan& plan) {
  const Style& y = plan.style;
  const Places& p = plan.at;
  const Bones& b = plan.bones;
  const double r = y.barrel, c = r * y.chest, w = r * y.waist,
               deep = std::min(1.0, 0.75 * y.height / (0.17 * c));
  flesh.trunk.push_back({.from = p.hips + Vec3(0, 0, -0.07),
                         .to = p.neck + Vec3(0, -0.05, -0.02),
                         .front = Vec3::UnitY(),
                         .sections = {{0.00, 0.085 * r, 0.08 * r, 0.085 * r * deep},
                                      {0.15, 0.108 * r, 0.092 * r, 0.105 * r * deep},
                                      {0.40, 0.105 * w, 0.082 * r, 0.12 * w * deep},
                                      {0.65, 0.122 * c, (0.088 + 0.06 * y.hump) * r, 0.16 * c * deep},
                                      {0.85, 0.115 * c, (0.1 + 0.05 * y.hump) * r, 0.15 * c * deep},
                                      {1.00, 0.085 * c, 0.085 * r, 0.105 * c * deep}},
                         .start_cap = 0.05 + 0.03 * r,
                         .end_cap = 0.05 + 0.02 * r,
                         .bones = {{b.hips}, {b.spine, 0.38, 0.14}, {b.chest, 0.66, 0.14}},
                         .blend = 0.06});
  const double n = std::sqrt(r), h = std::sqrt(y.head);
  flesh.trunk.push_back(
      {.from = p.neck - 0.06 * (p.head - p.neck).normalized() - Vec3(0, 0.05, 0),
       .to = p.head,
       .front = y.neck_up > 45 ? Vec3(-Vec3::UnitZ()) : Vec3::UnitY(),
       .sections = {{0, 0.075 * c, 0.085 * r, 0.105 * c * deep},
                    {0.5, 0.06 * n, 0.068 * n, 0.08 * n},
                    {1, 0.05 * h, 0.055 * h, 0.058 * h}},
       .start_cap = 0.05,
       .end_cap = 0.05,
       .bones = {{b.chest}, {b.neck, 0.06 / (y.neck + 0.06) + 0.08, 0.1}, {b.head, 0.92, 0.06}},
       .blend = 0.065,
       .detail = 0.85});
}

void add_tail(Flesh& flesh, const Plan& plan) {
  const Places& p = plan.at;
  const Bones& b = plan.bones;
  const double t = 0.024 * plan.style.tail_thick, stretch = plan.style.tail / 3;
  for (int i = 0; i < 3; ++i) {
    const double thick = std::max(0.014, t * (1 - 0.24 * i));
    Sweep tail =
        cone(p.tail[i], p.tail[i + 1], thick, std::max(0.012, t * (0.78 - 0.24 * i)), b.tail[i], 0.02);
    tail.bones = {{i == 0 ? b.hips : b.tail[i - 1]}, {b.tail[i], 0.0, std::min(0.06, 0.5 * stretch)}};
    tail.detail = 0.6;
    if (i == 0) tail.blend = 0.04;
    flesh.tail.push_back(tail);
  }
}

void add_head(Flesh& flesh, const Plan& plan) {
  const Style& y = plan.style;
  const Places& p = plan.at;
  const double h = y.head, w = h * y.head_wide, m = h * y.muzzle_thick;
  const Vec3 up = p.along.cross(Vec3(Vec3::UnitX())), tip = p.nose - 0.03 * h * p.along;
  flesh.head.push_back({.from = p.head,
                        .to = tip,
                        .front = up.y() > 0 ? up : Vec3(-up),
                        .sections = {{0.00, 0.068 * w, 0.064 * h, 0.058 * h},
                                     {0.28, 0.07 * w, 0.066 * h, 0.062 * h, 0.006 * h},
                                     {0.52, 0.05 * w, 0.046 * h, 0.056 * m, -0.004 * h},
                                     {0.75, 0.04 * m, 0.032 * m, 0.046 * m, -0.008 * h},
                                     {1.00, 0.035 * m, 0.028 * m, 0.034 * m, -0.008 * h}},
                        .start_cap = 0.06 * h,
                        .end_cap = 0.03 * h,
                        .bones = {{plan.bones.head}},
                        .blend = 0.04,
                        .detail = 0.7});
  const Vec3 brow = p.head + 0.09 * h * p.along;
  Sweep socket = ellipsoid(brow + h * Vec3(0.058 * y.head_wide, 0.022, 0.03), h * Vec3(0.014, 0.016, 0.02),
                           plan.bones.head, 0.016);
  socket.carve = socket.paired = true;
  flesh.head.push_back(socket);
  if (y.trunk > 0) {
    const double t = std::min(y.trunk * h, (tip.y() - 0.09) / 0.29);  // ends above the ground
    const Vec3 half = tip + t * Vec3(0, -0.13, 0.07), end = half + t * Vec3(0, -0.16, 0.02);
    flesh.head.push_back(cone(tip, half, 0.045 * h, 0.034 * h, plan.bones.head, 0.03));
    flesh.head.push_back(cone(half, end, 0.034 * h, 0.024 * h, plan.bones.head, 0.02));
  }
}

void add_ears(Flesh& flesh, const Plan& plan) {
  const Style& y = plan.style;
  const Places& p = plan.at;
  const double h = y.head;
  const double e = h * y.ears, wide = std::max(0.02, 0.034 * e * y.ear_wide),
               flat = std::max(0.011, 0.012 * h);
  flesh.ears.push_back({.from = p.ear,
                        .to = p.ear_tip,
                        .front = Vec3(0.4, 0, 1),
                        .sections = {{0, 0.85 * wide, flat, 1.2 * flat},
                                     {0.45, wide, flat, flat},
                                     {1, 0.4 * wide, 0.8 * flat, 0.8 * flat}},
                        .start_cap = 0.02,
                        .end_cap = 0.012 + 0.1 * wide,
                        .bones = {{plan.bones.head}, {plan.bones.ear, 0.05, 0.03}},
                        .blend = 0.018,
                        .detail = 0.6,
                        .paired = true});
}

// From the trunk's joint down to the paw.
void add_leg(Flesh& flesh, const Style& y, const std::array<Vec3, 5>& joints, int trunk,
             const std::array<int, 4>& bones, double thigh) {
  const double l = y.limbs, thin = std::max(0.026 * l, 0.018);
  Sweep upper = segment(joints[1], joints[0],
                        {{0, 0.042 * l, 0.05 * l, 0.05 * l},
                         {0.5, 0.052 * l, thigh * 0.07 * l, thigh * 0.07 * l},
                         {1, 0.056 * l, thigh * 0.082 * l, thigh * 0.08 * l}},
                        {bones[1], bones[0], trunk}, 0.09 * l, 0.06);
  Sweep lower = segment(joints[2], joints[1],
                        {{0, 1.15 * thin, 1.25 * thin, 1.25 * thin},
                         {0.6, 0.036 * l, 0.042 * l, 0.046 * l},
                         {1, 0.04 * l, 0.047 * l, 0.048 * l}},
                        {bones[2], bones[1], bones[0]}, 0.06 * l, 0.05);
  Sweep foot = segment(joints[3], joints[2],
                       {{0, 1.15 * thin, 1.15 * thin, 1.15 * thin},
                        {0.5, thin, 1.05 * thin, 1.05 * thin},
                        {1, 1.15 * thin, 1.25 * thin, 1.25 * thin}},
                       {bones[3], bones[2], bones[1]}, 0.035, 0.035);
  for (Sweep* s : {&upper, &lower, &foot}) {
    cap_round(*s, 0.9, 0.9);
    s->detail = (y.vertices < 900 ? 0.65 : 0.8) * std::clamp(l, 0.65, 1.1);  // thin ones need more vertices
    s->pair_blend = 0.008;
  }
  const double f = y.paws, ground = joints[3].y();
  const Vec3 heel = joints[3] + Vec3(0, -0.32 * ground, -0.008),
             toe(joints[4].x(), heel.y(), joints[4].z() - (y.hooves ? 0.5 : 0.3) * 0.085 * f);
  const double wide = std::max(1.25 * thin, 0.032 * f), low = 0.66 * ground;
  flesh.legs.insert(flesh.legs.end(), {upper, lower, foot});
  flesh.legs.push_back({.from = heel,
                        .to = toe,
                        .front = Vec3::UnitY(),
                        .sections = {{0, wide, 0.8 * ground, low}, {1, 1.15 * wide, 0.5 * ground, low}},
                        .start_cap = 0.028,
                        .end_cap = 0.03 * f,
                        .bones = {{bones[3]}},
                        .blend = 0.025,
                        .detail = 0.6,
                        .paired = true});
}

Mesh plain(const Shop& shop, const Sweep& sweep) {
  return tube(sweep, {.sides = std::max(5, shop.sides / 2), .rings = 1, .caps = 2});
}

void add_horns(Shop& shop, const Plan& plan) {
  const Places& p = plan.at;
  const double h = plan.style.head, size = 0.1 * h * plan.style.horns;
  const Vec3 from = p.head + h * Vec3(0.03 * plan.style.head_wide, 0.05, 0.03);
  const Vec3 bend = from + size * Vec3(shop.random.uniform(0.4, 1.2), shop.random.uniform(0.3, 1.2),
                                       shop.random.uniform(-0.5, 0.2));
  const Vec3 tip = bend + size * Vec3(shop.random.uniform(-0.5, 0.5), shop.random.uniform(0.4, 1.3),
                                      shop.random.uniform(-0.4, 0.4));
  const double thick = shop.random.uniform(0.011, 0.022) * h;
  Mesh horn = plain(shop, cone(from, bend, thick, 0.8 * thick, 0, 0));
  append(horn, plain(shop, cone(bend, tip, 0.8 * thick, 0.15 * thick, 0, 0)));
  for (int i = 0; i < 3 && plan.style.species == Species::deer; ++i) {
    const Vec3 root = bend + 0.33 * i * (tip - bend);
    append(horn, plain(shop, cone(root, root + 0.6 * size * Vec3(0.3, 0.6, 0.9 - 0.6 * i), 0.6 * thick,
                                  0.15 * thick, 0, 0)));
  }
  shop.add_rigid("horn", horn, plan.bones.head, true);
}

void add_face(Shop& shop, const Plan& plan) {
  const Places& p = plan.at;
  const double h = plan.style.head, big = shop.random.uniform(0.013, 0.026) * h;
  Vec3 eye = p.head + 0.09 * h * p.along + h * Vec3(0.03 * plan.style.head_wide, 0.024, 0.03);
  for (int i = 0; i < 60 && shop.body.distance(eye) < -0.3 * big; ++i) eye.x() += 0.003 * h;
  if (shop.chance(0.7))
    shop.add_rigid("eye", plain(shop, ellipsoid(eye, Vec3::Constant(big), 0, 0)), plan.bones.head, true);
  const double m = h * plan.style.muzzle_thick;
  if (shop.chance(0.5) && plan.style.trunk == 0)
    shop.add_rigid("nose",
                   plain(shop, ellipsoid(p.nose + m * Vec3(0, 0.004, 0), m * Vec3(0.02, 0.015, 0.016), 0, 0)),
                   plan.bones.head, false);
  if (shop.chance(0.25)) {
    Sweep jaw =
        ellipsoid(p.nose - 0.06 * h * p.along - m * Vec3(0, 0.012, 0), m * Vec3(0.024, 0.006, 0.03), 0, 0);
    shop.add_rigid("teeth", tube(jaw, {.sides = 6, .caps = 2}), plan.bones.head, false);
  }
  if (plan.style.trunk > 0 && shop.chance(0.7)) {
    const Vec3 from = p.nose + h * Vec3(0.035, -0.02, -0.03);
    shop.add_rigid("tusk",
                   plain(shop, cone(from, from + h * Vec3(0.02, -0.06, 0.1), 0.012 * h, 0.003 * h, 0, 0)),
                   plan.bones.head, true);
  }
}

void add_extras(Shop& shop, const Plan& plan) {
  const Places& p = plan.at;
  const Bones& b = plan.bones;
  add_face(shop, plan);
  if (plan.style.horns > 0) add_horns(shop, plan);
  if (plan.style.mane > 0) {
    const Vec3 back(0, 0.6, -0.6), thick = 0.055 * std::sqrt(plan.style.barrel) * back;
    const Vec3 low = p.neck + Vec3(0, 0.03, -0.03);
    Sweep mane = cone(low + thick, p.head + thick, 0.02, 0.02, 0, 0);
    mane.front = Vec3::UnitX();
    mane.sections = {{0, 0.07, 0.014, 0.014}, {1, 0.05, 0.014, 0.014}};
    Tube how = shop.usual();
    how.square = 0.5;
    shop.add("mane", tube(mane, how), ridden(shop.body, {b.neck, b.head, b.chest}), 1);
  }
  if (shop.chance(0.1)) {  // a saddle or a blanket
    Tube how = shop.usual();
    how.from = 0.42;
    how.to = shop.random.uniform(0.6, 0.75);
    how.open_start = how.open_end = true;
    const double low = p.spine.y() - shop.random.uniform(0, 0.1);
    const Mesh all = tube(inflated(flesh_of(plan).trunk[0], 0.015), how);
    shop.add("saddle", clip(all, [=](const Vec3& q) { return low - q.y(); }),
             ridden(shop.body, {b.spine, b.chest, b.hips}), 0);
  }
  if (shop.chance(0.12)) {
    const Vec3 along = (p.head - p.neck).normalized(), at = p.neck + 0.55 * (p.head - p.neck);
    const double r = 0.078 * std::sqrt(plan.style.barrel);
    Sweep ring = cone(at - 0.015 * along, at + 0.015 * along, r, r, 0, 0);
    shop.add_rigid("collar", tube(ring, {.sides = std::max(6, shop.sides), .rings = 1, .caps = 0}), b.neck,
                   false);
  }
}

void make_flesh(Shop& shop, const Plan& plan, const Flesh& f) {
  const int n = plan.style.vertices;
  const double thin = std::clamp(0.5 * plan.style.limbs * 0.03, 0.0115, 0.018);
  // Apart from the body: by taste, and where large triangles would break what is thin.
  const bool ears = plan.style.make != Make::skin || n < 700 || shop.chance(0.25);
  const bool tail = n < 1000 || plan.style.tail < 0.2 || plan.style.tail_thick < 0.8 || shop.chance(0.15);
  if (plan.style.make == Make::tubes) {
    Tube how = shop.usual();
    for (const Sweep& s : f.all())
      if (!s.carve) shop.add_tube("flesh" + std::to_string(shop.parts.size()), s, how);
    return;
  }
  if (plan.style.make == Make::skin) {
    std::vector<Sweep> most = joined({&f.trunk, &f.legs, &f.head});
    if (!tail) most.insert(most.end(), f.tail.begin(), f.tail.end());
    if (!ears) most.push_back(f.ears[0]);
    shop.add_surface("body", most, thin, n);
  } else {
    shop.add_surface("body", tail ? f.trunk : joined({&f.trunk, &f.tail}), thin, std::max(120, n / 3));
    shop.add_surface("head", f.head, thin, std::max(80, n / 4));
    const std::vector<Sweep> front(f.legs.begin(), f.legs.begin() + 4),
        hind(f.legs.begin() + 4, f.legs.end());
    shop.add_paired_surface("frontLeg", front, thin, std::max(110, n / 8));
    shop.add_paired_surface("hindLeg", hind, thin, std::max(110, n / 8));
  }
  for (const Sweep& s : f.tail)
    if (tail) shop.add_tube("tail", s, shop.usual());
  if (ears) shop.add_tube("ear", f.ears[0], shop.usual());
}

}  // namespace

Flesh flesh_of(const Plan& plan) {
  const Places& p = plan.at;
  const Bones& b = plan.bones;
  Flesh flesh;
  add_trunk(flesh, plan);
  add_tail(flesh, plan);
  add_head(flesh, plan);
  add_ears(flesh, plan);
  add_leg(flesh, plan.style, {p.shoulder, p.elbow, p.wrist, p.front_paw, p.front_toe}, b.chest,
          {b.front_upper, b.front_lower, b.front_foot, b.front_paw}, 1);
  add_leg(flesh, plan.style, {p.hip, p.knee, p.hock, p.hind_paw, p.hind_toe}, b.hips,
          {b.hind_upper, b.hind_lower, b.hind_foot, b.hind_paw}, 1.25);
  return flesh;
}

}  // namespace beast

Character make_quadruped(const std::string& name, Random& random) {
  const beast::Plan plan = beast::plan_quadruped(random);
  const beast::Flesh flesh = beast::flesh_of(plan);
  const Body body(flesh.all(), plan.bones.all.mirror, {});
  Shop shop{plan.bones.all, body, random, plan.style.sides, plan.style.vertices, plan.style.square};
  beast::make_flesh(shop, plan, flesh);
  beast::add_extras(shop, plan);
  return finish({name, plan.bones.all, body, beast::anchors(plan), beast::freedoms(plan)},
                std::move(shop.parts), random);
}

}  // namespace creatures::game
