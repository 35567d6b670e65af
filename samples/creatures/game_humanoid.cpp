// A game humanoid from its plan: flesh, clothes, gear, and one character out of all parts.
#include "game_humanoid.h"

#include <algorithm>
#include <cmath>

#include "game.h"

namespace creatures::game {
namespace {

void add_hand_surface(Workshop& shop) {
  if (shop.plan.style.vertices < 900) {
    const Tube how{.sides = shop.plan.style.sides < 7 ? 4 : 5, .rings = 1, .caps = 1};
    for (const Sweep& s : shop.flesh.hands) shop.add_tube("hand", s, how);
    return;
  }
  const double thin = shop.flesh.hands.back().sections.front().side;
  shop.add_paired_surface("hand", shop.flesh.hands, std::clamp(0.9 * thin, 0.007, 0.016),
                          std::clamp(shop.plan.style.vertices / 9, 90, 260));
}

void add_pieces(Workshop& shop) {
  const Flesh& f = shop.flesh;
  const int n = shop.plan.style.vertices;
  shop.add_surface("head", f.head, 0.02, std::max(90, n / 4));
  const bool cut_off = shop.chance(0.5), fingers = shop.plan.style.hand == Hand::fingers;
  if (cut_off) {
    shop.add_surface("torso", f.torso, 0.024, std::max(90, n / 4));
    shop.add_paired_surface("arm", fingers ? f.arms : joined({&f.arms, &f.hands}), 0.02, std::max(70, n / 9));
  } else {
    shop.add_surface("torso", fingers ? joined({&f.torso, &f.arms}) : joined({&f.torso, &f.arms, &f.hands}),
                     0.022, std::max(160, 2 * n / 5));
  }
  if (fingers) add_hand_surface(shop);
  shop.add_paired_surface("leg", joined({&f.legs, &f.feet}), 0.022, std::max(80, n / 7));
}

void add_tubes(Workshop& shop) {
  const Flesh& f = shop.flesh;
  const auto add = [&](const std::string& name, const std::vector<Sweep>& sweeps, Tube how) {
    for (const Sweep& s : sweeps)
      if (!s.carve && !(name == "torso" && s.from == s.to)) shop.add_tube(name, s, how);
  };
  Tube how = shop.usual(), fine = how;
  fine.sides = std::max(4, how.sides / 2 + 1);
  fine.rings = 2;
  how.rings += 1;
  add("torso", f.torso, how);
  add("arm", f.arms, how);
  add("hand", f.hands, fine);
  add("leg", f.legs, how);
  add("foot", f.feet, how);
  how.caps = std::max(2, how.sides / 3);
  add("head", f.head, how);
}

}  // namespace

void make_flesh(Workshop& shop) {
  const Flesh& f = shop.flesh;
  if (shop.plan.style.make == Make::tubes) return add_tubes(shop);
  if (shop.plan.style.make == Make::pieces) return add_pieces(shop);
  const bool fingers = shop.plan.style.hand == Hand::fingers;
  const auto most = joined({&f.torso, &f.legs, &f.feet, &f.arms});
  shop.add_surface("body", fingers ? joined({&most, &f.head}) : joined({&most, &f.hands, &f.head}), 0.02,
                   shop.plan.style.vertices);
  if (fingers) add_hand_surface(shop);
}

void hide_flesh(Workshop& shop, size_t flesh_parts) {
  std::vector<bool> hidden(static_cast<size_t>(shop.bone_count()), false);
  for (int b : shop.covered)
    hidden[static_cast<size_t>(b)] = hidden[static_cast<size_t>(shop.plan.bones.all.mirror[b])] = true;
  const bool away = shop.chance(0.45);
  const double deeper = shop.plan.style.vertices < 1000 ? 0.02 : 0.009;
  for (size_t i = 0; i < flesh_parts; ++i) {
    Part& part = shop.parts[i];
    std::vector<double> share;
    for (const Influences& v : part.skin) {
      share.push_back(0);
      for (int k = 0; k < max_influences; ++k)
        if (hidden[static_cast<size_t>(v.joints[k])]) share.back() += v.weights[k];
    }
    if (away) {
      std::erase_if(part.mesh.triangles, [&](const Triangle& t) {
        return std::min({share[t[0]], share[t[1]], share[t[2]]}) > 0.7;
      });
      drop_loose_vertices(part);
    } else {
      for (size_t v = 0; v < share.size(); ++v)
        part.mesh.positions[v] -= share[v] * deeper * shop.body.gradient(part.mesh.positions[v]).normalized();
    }
  }
  std::erase_if(shop.parts, [](const Part& part) { return part.mesh.triangles.empty(); });
}

Character make_humanoid(const std::string& name, Random& random) {
  const Plan plan = plan_humanoid(random);
  const Flesh flesh = flesh_of(plan);
  const Body body(flesh.all(), plan.bones.all.mirror, {});
  Workshop shop{
      {plan.bones.all, body, random, plan.style.sides, plan.style.vertices, plan.style.square}, plan, flesh};
  const bool robot = plan.style.kind == Kind::robot || plan.style.kind == Kind::blocky;
  if (robot) {
    make_robot(shop);
  } else {
    make_flesh(shop);
    const size_t flesh_parts = shop.parts.size();
    dress(shop);
    hide_flesh(shop, flesh_parts);
    make_head_gear(shop);
  }
  if (!robot || shop.chance(0.4)) equip(shop);
  return finish({name, plan.bones.all, body, anchors(plan), freedoms(plan)}, std::move(shop.parts), random);
}

}  // namespace creatures::game
