// What sits on the head of a game humanoid: eyes, teeth, hair, ears, horns, hats and helmets. All of it rides on the head.
#include <algorithm>
#include <cmath>

#include "game_humanoid.h"

namespace creatures::game {
namespace {

// At (x, y, z) times the radii of the skull from its middle.
Vec3 on_head(const Workshop& shop, double x, double y, double z) {
  return shop.plan.at.skull + Vec3(x, y, z).cwiseProduct(shop.plan.at.skull_radii);
}

Sweep lump(const Workshop& shop, const Vec3& at, const Vec3& radii) {
  return ellipsoid(on_head(shop, at.x(), at.y(), at.z()), radii.cwiseProduct(shop.plan.at.skull_radii),
                   shop.plan.bones.head, 0);
}

void add(Workshop& shop, const std::string& name, const Mesh& mesh, bool paired = false) {
  shop.add_rigid(name, mesh, shop.plan.bones.head, paired);
}

Mesh round(const Workshop& shop, const Sweep& sweep, int caps = 0) {
  Tube how = shop.usual();
  how.square = 0;
  how.caps = caps ? caps : std::max(2, how.sides / 4);
  return tube(sweep, how);
}

Mesh box(const Vec3& at, const Vec3& half) {
  Sweep s = ellipsoid(at, half, 0, 0);
  s.from.y() -= half.y();
  s.to.y() += half.y();
  s.sections.push_back({1, half.x(), half.z(), half.z()});
  return tube(s, {.sides = 4, .rings = 1, .caps = 0, .square = 1});
}

// Where the ray from inside the head leaves it, pushed in by a share of the skull.
Vec3 face_point(const Workshop& shop, double x, double y, double in) {
  Vec3 p = on_head(shop, x, y, 0.3);
  const double step = 0.02 * shop.plan.at.skull_radii.z();
  for (int i = 0; i < 200 && shop.body.distance(p) < 0; ++i) p.z() += step;
  p.z() -= in * shop.plan.at.skull_radii.z();
  return p;
}

void add_eyes(Workshop& shop) {
  const Style& y = shop.plan.style;
  const Vec3 r = shop.plan.at.skull_radii;
  const double size = 0.155 * std::min(y.eyes, 1.9) * shop.random.uniform(0.85, 1.2);
  const double apart = std::max(0.42, 1.15 * size), level = y.eyes > 1.4 ? -0.5 : -0.38;
  const Vec3 at = face_point(shop, apart, level, 0.75 * size);
  const Vec3 radii(size * r.x(), size * r.y() * shop.random.uniform(0.9, 1.4), size * r.z());
  add(shop, "eye", round(shop, ellipsoid(at, radii, 0, 0), 3), true);
  if (shop.chance(0.4)) {
    const Vec3 out = at + Vec3(0, 0, 0.75 * radii.z());
    add(shop, "pupil", round(shop, ellipsoid(out, {0.5 * radii.x(), 0.5 * radii.y(), 0.4 * radii.z()}, 0, 0)),
        true);
  }
  if (shop.chance(0.3))
    add(shop, "brow",
        box(at + Vec3(0, 1.7 * radii.y(), 0.5 * radii.z()),
            {1.1 * radii.x(), 0.012 * r.y() + 0.002, 0.3 * radii.z()}),
        true);
  if (shop.chance(0.08))
    add(shop, "glasses", box(at + Vec3(0, 0, radii.z()), {1.25 * radii.x(), 1.2 * radii.y(), 0.04 * r.z()}),
        true);
}

void add_teeth(Workshop& shop) {
  const Vec3 r = shop.plan.at.skull_radii;
  const Vec3 at = face_point(shop, 0, -0.98, 0.3);
  for (double dy : {0.05, -0.05})
    add(shop, dy > 0 ? "teethUp" : "teethLow",
        box(at + Vec3(0, dy * r.y(), 0), {0.26 * r.x(), 0.035 * r.y(), 0.16 * r.z()}));
  if (shop.chance(0.5))
    add(shop, "tongue",
        box(at - Vec3(0, 0.02 * r.y(), 0.2 * r.z()), {0.15 * r.x(), 0.03 * r.y(), 0.2 * r.z()}));
}

// The skull, further out, open over the face and below.
Mesh dome(const Workshop& shop, double ease, double low, double face) {
  const Places& p = shop.plan.at;
  Tube how = shop.usual();
  how.square = 0;
  how.sides = std::max(8, how.sides);
  how.caps = std::max(3, how.sides / 3);
  Sweep s = lump(shop, {0, 0, 0}, {1, 1, 1});
  const Sweep head = shop.flesh.head.front();
  double side = 0, back = 0;
  for (const Section& c : head.sections) side = std::max(side, c.side), back = std::max(back, c.back);
  if (head.sections.size() == 1) s = ellipsoid(head.from, {side, head.start_cap, back}, 0, 0);
  s = inflated(s, ease * p.skull_radii.y());
  return clip(tube(s, how), [=](const Vec3& q) {
    const Vec3 u = (q - p.skull).cwiseQuotient(p.skull_radii);
    return std::max(low - u.y(), std::min(u.z() - 0.35, face - u.y()));
  });
}

void add_spikes(Workshop& shop, const std::string& name, int count, double size) {
  Mesh all;
  for (int i = 0; i < count; ++i) {
    const double a = shop.random.uniform(-2.6, 2.6) + EIGEN_PI, up = shop.random.uniform(0.1, 1.2);
    const Vec3 way(std::sin(a) * std::cos(up), std::sin(up), std::cos(a) * std::cos(up));
    const Vec3 from = on_head(shop, 0.75 * way.x(), 0.75 * way.y(), 0.75 * way.z());
    const Vec3 droop(0, shop.random.uniform(-0.5, 0.3), -0.25);
    const Vec3 to = from + size * shop.plan.at.skull_radii.y() * (way + droop);
    Sweep s = cone(from, to, 0.3 * shop.plan.at.skull_radii.y(), 0.02 * shop.plan.at.skull_radii.y(), 0, 0);
    append(all, tube(s, {.sides = 5, .rings = 2, .caps = 1}));
  }
  add(shop, name, all);
}

// Falls from the crown down the back.
void add_long_hair(Workshop& shop) {
  const Vec3 r = shop.plan.at.skull_radii;
  const double long_ = shop.random.uniform(0.8, 3) * r.y();
  const Vec3 from = on_head(shop, 0, 0.3, -0.7),
             to = from - Vec3(0, long_, shop.random.uniform(0, 0.5) * r.z());
  Sweep s = cone(from, to, 0.85 * r.x(), 0.5 * r.x(), 0, 0);
  s.front = Vec3::UnitZ();
  s.sections = {{0, 0.9 * r.x(), 0.5 * r.z(), 0.45 * r.z()},
                {0.5, r.x(), 0.35 * r.z(), 0.4 * r.z()},
                {1, shop.random.uniform(0.3, 1) * r.x(), 0.2 * r.z(), 0.25 * r.z()}};
  s.start_cap = 0.4 * r.y();
  s.end_cap = 0.2 * r.y();
  add(shop, "hairBack", round(shop, s, 2));
}

void add_tails_of_hair(Workshop& shop, bool twin) {
  const Vec3 r = shop.plan.at.skull_radii;
  const Vec3 from = twin ? on_head(shop, 0.95, 0.35, -0.3) : on_head(shop, 0, 0.4, -1);
  const Vec3 to =
      from + r.y() * Vec3(twin ? shop.random.uniform(0.2, 0.9) : 0, shop.random.uniform(-2.2, -0.5), -0.5);
  Sweep s = cone(from, to, 0.25 * r.y(), 0.1 * r.y(), 0, 0);
  s.sections.insert(s.sections.begin() + 1, {0.5, 0.32 * r.y(), 0.32 * r.y(), 0.32 * r.y()});
  add(shop, "hairTail", round(shop, s), twin);
}

// Open strips around the back of the head, like hair cards.
void add_cards(Workshop& shop) {
  const Places& p = shop.plan.at;
  const int count = static_cast<int>(shop.random.uniform(5, 12));
  const double long_ = shop.random.uniform(0.4, 1.6);
  Mesh all;
  for (int i = 0; i < count; ++i) {
    const double middle = EIGEN_PI + 2.2 * (2.0 * i / (count - 1) - 1), half = 1.6 / count;
    append(all, sheet(1, 3, [&](double u, double v) -> Vec3 {
             const double a = middle + half * (2 * u - 1), turn = 0.3 + 1.25 * std::min(1.5 * v, 1.0);
             const double down = std::max(0.0, v - 0.667) * 3 * long_;
             const double out = 1.1 * std::sin(turn);
             return p.skull + p.skull_radii.cwiseProduct(
                                  Vec3(out * std::sin(a), 1.12 * std::cos(turn) - down, out * std::cos(a)));
           }));
  }
  add(shop, "hairCards", all);
}

void add_hair(Workshop& shop) {
  const Vec3 r = shop.plan.at.skull_radii;
  const double kind = shop.random.uniform(0, 1);
  if (kind < 0.85)
    add(shop, "hair",
        dome(shop, shop.random.uniform(0.04, 0.2), shop.random.uniform(-0.9, 0.1),
             shop.random.uniform(0.05, 0.5)));
  if (kind < 0.2) add_long_hair(shop);
  if (kind > 0.2 && kind < 0.32) add_tails_of_hair(shop, false);
  if (kind > 0.32 && kind < 0.42) add_tails_of_hair(shop, true);
  if (kind > 0.42 && kind < 0.6)
    add_spikes(shop, "hairSpikes", 7 + static_cast<int>(shop.random.uniform(0, 12)),
               shop.random.uniform(0.5, 1));
  if (kind > 0.6 && kind < 0.72) add_cards(shop);
  if (kind > 0.72 && kind < 0.8) add(shop, "bun", round(shop, lump(shop, {0, 0.9, -0.7}, {0.4, 0.35, 0.4})));
  if (kind > 0.9)
    add(shop, "mohawk", box(on_head(shop, 0, 0.75, -0.25), {0.12 * r.x(), 0.55 * r.y(), 0.95 * r.z()}));
  if (shop.chance(0.25))
    add(shop, "fringe",
        round(shop, lump(shop, {shop.random.uniform(-0.3, 0.3), 0.35, 0.85}, {0.7, 0.3, 0.25})));
}

void add_beard(Workshop& shop) {
  const Vec3 r = shop.plan.at.skull_radii;
  const Vec3 at = face_point(shop, 0, -1.0, 0.25);
  const double long_ = shop.random.uniform(0.2, 0.9);
  Sweep s = cone(at, at - Vec3(0, long_ * r.y(), -0.1 * r.z()), 0.5 * r.x(), 0.2 * r.x(), 0, 0);
  s.front = Vec3::UnitZ();
  s.sections = {{0, 0.62 * r.x(), 0.3 * r.z(), 0.4 * r.z()}, {1, 0.25 * r.x(), 0.14 * r.z(), 0.14 * r.z()}};
  add(shop, "beard", round(shop, s, 2));
  if (shop.chance(0.4))
    add(shop, "moustache",
        round(shop,
              ellipsoid(face_point(shop, 0.15, -0.8, 0), {0.3 * r.x(), 0.09 * r.y(), 0.12 * r.z()}, 0, 0)),
        true);
}

void add_ears(Workshop& shop) {
  const double y = shop.plan.at.skull_radii.y(), kind = shop.random.uniform(0, 1);
  const auto horn = [&](const std::string& name, const Vec3& from, const Vec3& way, double wide,
                        double flat) {
    Sweep s = cone(from, from + y * way, wide * y, 0.15 * wide * y, 0, 0);
    s.front = Vec3::UnitZ();
    for (Section& c : s.sections) c.front *= flat, c.back *= flat;
    if (kind > 0.35)
      s.sections.insert(s.sections.begin() + 1,
                        {0.45, 1.1 * wide * y, 1.1 * wide * y * flat, 1.1 * wide * y * flat});
    add(shop, name, round(shop, s, 2), true);
  };
  const Vec3 high = on_head(shop, 0.5, 0.75, 0), side = on_head(shop, 0.9, -0.35, -0.05);
  if (kind < 0.3)
    horn("ear", high, {0.35, 0.7, 0}, 0.3, 0.4);  // a cat's
  else if (kind < 0.5)
    horn("ear", high, {shop.random.uniform(0.1, 0.7), shop.random.uniform(0.9, 1.7), -0.1}, 0.24,
         0.5);  // a rabbit's
  else if (kind < 0.65)
    horn("ear", high, {0.3, 0.3, 0}, 0.4, 0.45);  // a bear's
  else if (kind < 0.85)
    horn("ear", side, {shop.random.uniform(0.4, 1.1), shop.random.uniform(0.1, 0.5), -0.3}, 0.16,
         0.5);  // an elf's
  else
    horn("ear", side, {0.5, -1.1, 0}, 0.25, 0.5);  // hanging
}

void add_horns(Workshop& shop) {
  const double y = shop.plan.at.skull_radii.y();
  const Vec3 from = on_head(shop, 0.6, 0.6, 0.1);
  const Vec3 elbow = from + y * Vec3(shop.random.uniform(0.1, 0.7), shop.random.uniform(0.2, 0.5), 0.05);
  const Vec3 to = elbow + y * Vec3(shop.random.uniform(-0.2, 0.3), shop.random.uniform(0.2, 0.7),
                                   shop.random.uniform(-0.3, 0.4));
  const double thick = shop.random.uniform(0.12, 0.25) * y;
  Mesh mesh = round(shop, cone(from, elbow, thick, 0.7 * thick, 0, 0), 2);
  append(mesh, round(shop, cone(elbow, to, 0.75 * thick, 0.1 * thick, 0, 0), 2));
  add(shop, "horn", mesh, true);
}

// A disc around the head, bent a little.
Mesh brim(const Workshop& shop, double level, double reach, double thick) {
  return round(shop, lump(shop, {0, level, 0}, {reach, thick, reach}), 2);
}

void add_hat(Workshop& shop) {
  const Vec3 r = shop.plan.at.skull_radii;
  const double kind = shop.random.uniform(0, 1), grow = shop.random.uniform(1.05, 1.3);
  const auto crown = [&](double low, double high, double tip, double lean) {
    Sweep s = cone(on_head(shop, 0, low, 0), on_head(shop, 0, high, lean), grow * r.x(), tip * r.x(), 0, 0);
    s.front = Vec3::UnitZ();
    s.sections[0].front = s.sections[0].back = grow * r.z();
    s.end_cap = 0.15 * r.y();
    s.start_cap = 0.02 * r.y();
    add(shop, "hat", round(shop, s, 1));
  };
  if (kind < 0.2) {  // a pointed hat
    add(shop, "brim", brim(shop, 0.35, shop.random.uniform(1.6, 2.4), 0.06));
    crown(0.3, shop.random.uniform(1.8, 2.9), 0.1, shop.random.uniform(-0.8, 0));
  } else if (kind < 0.35) {  // a top hat
    add(shop, "brim", brim(shop, 0.5, shop.random.uniform(1.35, 1.7), 0.06));
    crown(0.45, shop.random.uniform(1.3, 2.1), shop.random.uniform(0.9, 1.2), 0);
  } else if (kind < 0.5) {  // a straw hat
    add(shop, "brim", brim(shop, 0.45, shop.random.uniform(1.7, 2.8), 0.1));
    add(shop, "hat", dome(shop, 0.15, 0.35, 0.4));
  } else if (kind < 0.75) {  // a cap
    add(shop, "hat", dome(shop, shop.random.uniform(0.1, 0.25), 0.25, 0.3));
    if (shop.chance(0.7)) add(shop, "visor", round(shop, lump(shop, {0, 0.3, 1.1}, {0.8, 0.07, 0.7}), 2));
  } else if (kind < 0.87) {  // a crown
    Sweep s =
        cone(on_head(shop, 0, 0.45, 0), on_head(shop, 0, 1.05, 0), grow * r.x(), 1.1 * grow * r.x(), 0, 0);
    Tube how = shop.usual();
    how.rings = 1;
    how.open_start = how.open_end = true;
    add(shop, "crown", tube(s, how));
  } else {  // a hood
    add(shop, "hood", dome(shop, shop.random.uniform(0.15, 0.35), -1.15, shop.random.uniform(0.3, 0.6)));
  }
}

void add_helmet(Workshop& shop) {
  const double ease = shop.random.uniform(0.1, 0.25);
  add(shop, "helmet", dome(shop, ease, shop.random.uniform(-1.3, -0.2), shop.random.uniform(-0.1, 0.35)));
  if (shop.chance(0.35)) add(shop, "visor", round(shop, lump(shop, {0, -0.25, 0.5}, {0.95, 0.4, 0.75})));
  if (shop.chance(0.3)) add_horns(shop);
  if (shop.chance(0.3))
    add(shop, "crest",
        box(on_head(shop, 0, 1.15, -0.2), shop.plan.at.skull_radii.cwiseProduct(Vec3(0.08, 0.35, 0.9))));
}

}  // namespace

void make_head_gear(Workshop& shop) {
  const bool animal = shop.plan.style.kind == Kind::mascot;
  if (shop.chance(0.75)) add_eyes(shop);
  if (shop.chance(0.22)) add_teeth(shop);
  const double worn = shop.random.uniform(0, 1);
  if (worn < 0.22) add_hat(shop);
  if (worn > 0.22 && worn < 0.36) add_helmet(shop);
  if (shop.chance(animal ? 0.15 : worn > 0.36 ? 0.85 : 0.35)) add_hair(shop);
  if (shop.chance(animal ? 0.75 : 0.12)) add_ears(shop);
  if (shop.chance(animal ? 0.25 : 0.04)) add_horns(shop);
  if (shop.chance(0.1)) add_beard(shop);
}

}  // namespace creatures::game
