// Clothes of a game humanoid: from the flesh, a little further out.
#include <algorithm>
#include <cmath>

#include "game_humanoid.h"

namespace creatures::game {
namespace {

struct Cut {
  double ease, sleeve,
      leg;  // away from the flesh; how far down the limb: 0.5 elbow or knee, 1 wrist or ankle
  bool tight_hem;
};

std::vector<int> bones_of(const Plan& plan, std::initializer_list<int> left_ones) {
  std::vector<int> all;
  for (int b : left_ones) {
    all.push_back(b);
    if (plan.bones.all.mirror[b] != b) all.push_back(plan.bones.all.mirror[b]);
  }
  return all;
}

// The stretch of a limb's two segments from the trunk to the share `until` as tubes open at both ends.
void add_limb_tubes(Workshop& shop, const std::string& name, const Sweep& near, const Sweep& far, bool leg,
                    const Cut& cut) {
  const double until = leg ? cut.leg : cut.sleeve;
  Tube how = shop.usual();
  how.open_start = how.open_end = true;
  const auto stretch = [&](double a, double b) {  // legs run from below upwards
    how.from = leg ? 1 - b : a;
    how.to = leg ? 1 - a : b;
  };
  stretch(0, std::min(2 * until, 1.0));
  shop.add_tube(name, inflated(near, cut.ease), how);
  if (until <= 0.5) return;
  stretch(0, 2 * until - 1);
  shop.add_tube(name + "Low", inflated(far, cut.tight_hem ? 0.9 * cut.ease : 1.3 * cut.ease), how);
}

// One blended surface out of some of the flesh, with open borders where `outside` is positive.
void add_fabric(Workshop& shop, const std::string& name, std::vector<Sweep> sweeps, double ease,
                const std::function<double(const Vec3&)>& outside, double share) {
  for (Sweep& s : sweeps) s = inflated(s, ease);
  const Body body(sweeps, shop.plan.bones.all.mirror, {});
  const int vertices = std::max(90, static_cast<int>(share * shop.plan.style.vertices));
  const Mesh closed = surface_of(body, 0.026, vertices, shop.random);
  shop.add(
      name, clip(closed, outside), [&](const Vec3& p) { return shop.body.bone_weights(p); }, 2);
}

void add_shirt(Workshop& shop, const Cut& cut) {
  const Places& p = shop.plan.at;
  const Flesh& flesh = shop.flesh;
  const double hem = p.hip.y() + shop.random.uniform(-0.1, 0.6) * (p.spine.y() - p.hip.y());
  if (shop.plan.style.make == Make::skin && shop.chance(0.6)) {
    std::vector<Sweep> sweeps = flesh.torso;
    if (cut.sleeve > 0) sweeps.push_back(flesh.arms[0]);
    if (cut.sleeve > 0.5) sweeps.push_back(flesh.arms[1]);
    const bool far = cut.sleeve > 0.5;
    const Vec3 end = far ? Vec3(p.elbow + (2 * cut.sleeve - 1) * (p.wrist - p.elbow))
                         : Vec3(p.shoulder + 2 * cut.sleeve * (p.elbow - p.shoulder));
    const Vec3 along = far ? p.forearm : p.arm;
    const double arm_width = 0.13 * p.width, trunk = 0.24 * p.width;
    const auto outside = [=](const Vec3& at) {
      const Vec3 q(std::abs(at.x()), at.y(), at.z());
      const double over = (q - end).dot(along);
      double f = std::max(q.y() - p.neck.y() - 0.005, -1.0);
      if (q.x() < trunk) f = std::max(f, hem - q.y());
      if ((q - end - over * along).norm() < arm_width) f = std::max(f, over);
      return f;
    };
    return add_fabric(shop, "shirt", sweeps, cut.ease, outside, 0.45);
  }
  Tube how = shop.usual();
  how.rings += 2;
  how.open_start = how.open_end = true;
  how.from = std::max(0.02, (hem - p.hip.y() + 0.03) / (p.neck.y() - p.hip.y() + 0.015));
  how.to = 0.97;
  shop.add_tube("shirt", inflated(flesh.torso[0], cut.ease), how);
  if (cut.sleeve > 0) add_limb_tubes(shop, "sleeve", flesh.arms[0], flesh.arms[1], false, cut);
}

void add_trousers(Workshop& shop, const Cut& cut) {
  const Places& p = shop.plan.at;
  const Flesh& flesh = shop.flesh;
  if (shop.plan.style.make == Make::skin && shop.chance(0.5)) {
    const double hem = cut.leg > 0.5 ? p.knee.y() + (2 * cut.leg - 1) * (p.ankle.y() - p.knee.y())
                                     : p.hip.y() + 2 * cut.leg * (p.knee.y() - p.hip.y());
    const double waist = p.spine.y() + 0.1 * (p.chest.y() - p.spine.y());
    const auto outside = [=](const Vec3& q) { return std::max(hem - q.y(), q.y() - waist); };
    return add_fabric(shop, "trousers", {flesh.torso[0], flesh.torso[3], flesh.legs[0], flesh.legs[1]},
                      cut.ease, outside, 0.4);
  }
  Tube how = shop.usual();
  how.open_end = true;
  how.to = 0.3;
  shop.add_tube("trousers", inflated(flesh.torso[0], 0.9 * cut.ease), how);
  add_limb_tubes(shop, "leg", flesh.legs[1], flesh.legs[0], true, cut);
}

// A skirt, a kilt or the long part of a coat or robe: open above and below, and in front if `slit`.
void add_skirt(Workshop& shop, double hem, double ease, bool slit) {
  const Plan& plan = shop.plan;
  const Places& p = plan.at;
  const double w = p.width, flare = shop.random.uniform(0.85, 1.7);
  const double waist = p.spine.y() - 0.1 * (p.spine.y() - p.hip.y()), long_ = waist - hem;
  const Section top = shop.flesh.torso[0].sections[2], hip = shop.flesh.torso[0].sections[1];
  const double at_hip = std::clamp((waist - p.hip.y()) / long_, 0.1, 0.8);
  const double legs = p.ankle.x() + 0.07 * w * plan.style.limbs;
  const double out = std::max(hip.side, legs) + 0.3 * flare * (1 - at_hip) * long_;
  const double deep = std::max(hip.front, 0.12 * w) + 0.26 * flare * (1 - at_hip) * long_;
  const Sweep skirt{.from = Vec3(0, waist, 0),
                    .to = Vec3(0, hem, 0),
                    .front = Vec3::UnitZ(),
                    .sections = {{0, top.side + ease, top.front + ease, top.back + ease},
                                 {at_hip, hip.side + 1.4 * ease, hip.front + 1.4 * ease, hip.back + 2 * ease},
                                 {1, out + ease, deep, deep}},
                    .start_cap = 0.01,
                    .end_cap = 0.01,
                    .bones = {{plan.bones.hips}},
                    .blend = 0};
  Tube how = shop.usual();
  how.open_start = how.open_end = true;
  how.sides = std::max(8, how.sides + 2);
  how.rings = std::max(2, how.rings);
  Mesh mesh = tube(skirt, how);
  if (slit)
    mesh = clip(mesh, [&](const Vec3& q) {
      return std::min(q.z(), 0.03 + 0.25 * (waist - q.y()) - std::abs(q.x()));
    });
  const std::vector<int> bones =
      bones_of(plan, {plan.bones.hips, plan.bones.upper_leg, plan.bones.lower_leg});
  shop.add(slit ? "coatTail" : "skirt", mesh, ridden(shop.body, bones), 2);
}

void add_boots(Workshop& shop) {
  const Style& y = shop.plan.style;
  const double ease = shop.random.uniform(0.006, 0.014), shaft = shop.random.uniform(-0.2, 0.85);
  Tube how = shop.usual();
  how.square = std::max(how.square, 0.3);
  how.caps = std::max(how.caps, 1);
  Sweep shoe = inflated(shop.flesh.feet[0], ease);
  for (Section& s : shoe.sections) s.back -= 0.8 * ease;
  shop.add_tube("shoe", shoe, how);
  if (shaft < 0.1) return;
  how = shop.usual();
  how.open_start = true;
  how.open_end = shop.chance(0.7);
  how.caps = 0;
  how.to = shaft;
  shop.add_tube("bootLeg", inflated(shop.flesh.legs[0], 1.3 * ease + 0.004 * y.limbs), how);
}

void add_gloves(Workshop& shop) {
  const double ease = shop.random.uniform(0.003, 0.01);
  Tube how = shop.usual();
  if (shop.plan.style.hand != Hand::fingers)
    for (const Sweep& s : shop.flesh.hands) shop.add_tube("glove", inflated(s, ease), how);
  how.open_start = how.open_end = true;
  how.from = shop.random.uniform(0.4, 0.75);
  shop.add_tube("cuff", inflated(shop.flesh.arms[1], 2 * ease), how);
}

void add_band(Workshop& shop, const std::string& name, double from, double to, double ease) {
  Tube how = shop.usual();
  how.from = from;
  how.to = to;
  how.rings = 1;
  how.caps = 0;
  how.open_start = how.open_end = shop.chance(0.5);
  shop.add_tube(name, inflated(shop.flesh.torso[0], ease), how);
}

void add_scarf(Workshop& shop) {
  const Places& p = shop.plan.at;
  const double thick = shop.random.uniform(0.02, 0.045) * p.width;
  Sweep scarf = cone(p.neck - Vec3(0, 0.02, 0), p.neck + Vec3(0, 0.03, 0.004), 0.062 * p.width + thick,
                     0.055 * p.width + thick, shop.plan.bones.neck, 0);
  scarf.front = Vec3::UnitZ();
  Tube how = shop.usual();
  how.rings = 2;
  how.caps = 1;
  shop.add("scarf", tube(scarf, how), ridden(shop.body, {shop.plan.bones.upper_chest, shop.plan.bones.neck}),
           1);
}

}  // namespace

void dress(Workshop& shop) {
  const Places& p = shop.plan.at;
  const double hip = p.hip.y(), knee = p.knee.y();
  const double coarse = shop.plan.style.vertices < 1000 ? 0.008 : 0;  // wide chords would cut into the flesh
  Cut cut{coarse + shop.random.uniform(0.006, 0.018), shop.random.uniform(0.2, 0.98),
          shop.random.uniform(0.88, 1.0), shop.chance(0.5)};
  if (shop.chance(0.2)) cut.leg = shop.random.uniform(0.2, 0.6);
  if (shop.chance(0.15)) cut.sleeve = 0;
  const bool top = shop.chance(0.72);
  const double below = shop.random.uniform(0, 1);
  const Bones& b = shop.plan.bones;
  const auto cover = [&](bool covered, std::initializer_list<int> bones) {
    if (covered) shop.covered.insert(shop.covered.end(), bones);
  };
  cover(top, {b.spine, b.chest, b.upper_chest});
  cover(top && cut.sleeve > 0.2, {b.shoulder});
  cover(top && cut.sleeve > 0.6, {b.upper_arm});
  cover(below < 0.55, {b.hips});
  cover(below < 0.55 && cut.leg > 0.6, {b.upper_leg});
  if (top) add_shirt(shop, cut);
  if (below < 0.55) add_trousers(shop, cut);
  if (below > 0.52 && below < 0.72)
    add_skirt(shop, shop.random.uniform(knee - 0.3 * knee, 0.7 * hip + 0.3 * knee), cut.ease + 0.006, false);
  if (below > 0.72 && below < 0.82) add_skirt(shop, shop.random.uniform(0.03, knee), cut.ease + 0.01, false);
  if (top && shop.chance(0.18))
    add_skirt(shop, shop.random.uniform(0.5 * knee, 0.5 * (hip + knee)), cut.ease + 0.012, true);
  if (shop.chance(0.6)) add_boots(shop);
  if (shop.chance(0.2)) add_gloves(shop);
  if (shop.chance(0.4)) {
    const double at = shop.random.uniform(0.16, 0.28);
    add_band(shop, "belt", at, at + shop.random.uniform(0.04, 0.08), cut.ease + 0.012);
  }
  if (shop.chance(0.14)) add_scarf(shop);
}

}  // namespace creatures::game
