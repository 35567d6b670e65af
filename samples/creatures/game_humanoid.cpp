// A game humanoid from its plan: flesh, clothes, gear, and one character out of all parts.
#include "game_humanoid.h"

#include <algorithm>
#include <cmath>

#include "game.h"
#include "polygonise.h"
#include "remesh.h"

namespace creatures::game {
namespace {

Mesh surface(Workshop& shop, const Body& body, double cell, int vertices) {
  const Vec3 shift(shop.random.uniform(0, 1), shop.random.uniform(0, 1), shop.random.uniform(0, 1));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(shop.random.uniform(0, 3), Vec3(0.2, 0.5, 1).normalized()));
  return remesh(polygonise(body, cell, turn, shift), body, vertices, shop.random);
}

void add_surface(Workshop& shop, const std::string& name, const std::vector<Sweep>& sweeps, double cell,
                 int vertices) {
  const Body body(sweeps, shop.plan.bones.all.mirror, random_asymmetry(shop.random, 0.001));
  shop.add(
      name, surface(shop, body, cell, vertices), [&](const Vec3& p) { return shop.body.bone_weights(p); },
      vertices > 2000  ? 4
      : vertices > 700 ? 1
                       : 0);
}

// One side's sweeps; the mesh is made once and mirrored.
void add_paired_surface(Workshop& shop, const std::string& name, std::vector<Sweep> sweeps, double cell,
                        int vertices) {
  for (Sweep& s : sweeps) s.paired = false;
  const Body body(sweeps, shop.plan.bones.all.mirror, {});
  const Mesh mesh = surface(shop, body, cell, vertices);
  const auto weights = [&](const Vec3& p) { return shop.body.bone_weights(p); };
  shop.add(name + ".L", mesh, weights, 2);
  shop.add(name + ".R", mirrored(mesh), weights, 2);
}

std::vector<Sweep> joined(std::initializer_list<const std::vector<Sweep>*> groups) {
  std::vector<Sweep> all;
  for (const auto* g : groups) all.insert(all.end(), g->begin(), g->end());
  return all;
}

void add_hand_surface(Workshop& shop) {
  if (shop.plan.style.vertices < 900) {
    const Tube how{.sides = shop.plan.style.sides < 7 ? 4 : 5, .rings = 1, .caps = 1};
    for (const Sweep& s : shop.flesh.hands) shop.add_tube("hand", s, how);
    return;
  }
  const double thin = shop.flesh.hands.back().sections.front().side;
  add_paired_surface(shop, "hand", shop.flesh.hands, std::clamp(0.9 * thin, 0.007, 0.016),
                     std::clamp(shop.plan.style.vertices / 9, 90, 260));
}

void add_pieces(Workshop& shop) {
  const Flesh& f = shop.flesh;
  const int n = shop.plan.style.vertices;
  add_surface(shop, "head", f.head, 0.02, std::max(90, n / 4));
  const bool cut_off = shop.chance(0.5), fingers = shop.plan.style.hand == Hand::fingers;
  if (cut_off) {
    add_surface(shop, "torso", f.torso, 0.024, std::max(90, n / 4));
    add_paired_surface(shop, "arm", fingers ? f.arms : joined({&f.arms, &f.hands}), 0.02,
                       std::max(70, n / 9));
  } else {
    add_surface(shop, "torso", fingers ? joined({&f.torso, &f.arms}) : joined({&f.torso, &f.arms, &f.hands}),
                0.022, std::max(160, 2 * n / 5));
  }
  if (fingers) add_hand_surface(shop);
  add_paired_surface(shop, "leg", joined({&f.legs, &f.feet}), 0.022, std::max(80, n / 7));
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

Tube Workshop::usual() const {
  const int sides = plan.style.sides;
  return {.sides = sides,
          .rings = std::clamp(sides / 2, 2, 7),
          .caps = sides < 7    ? 1
                  : sides < 12 ? 2
                               : 3,
          .square = plan.style.square};
}

void Workshop::add(const std::string& name, Mesh mesh, const WeightField& weights, int rounds) {
  if (mesh.triangles.empty()) return;
  std::vector<Influences> skin = skin_mesh(mesh, weights, rounds);
  parts.push_back({name, std::move(mesh), std::move(skin)});
}

void Workshop::add_rigid(const std::string& name, const Mesh& mesh, int bone, bool paired) {
  add(paired ? name + ".L" : name, mesh, rigid(bone, plan.bone_count()));
  if (paired) add(name + ".R", mirrored(mesh), rigid(plan.bones.all.mirror[bone], plan.bone_count()));
}

void Workshop::add_tube(const std::string& name, const Sweep& sweep, const Tube& how) {
  const std::vector<int>& mirror = plan.bones.all.mirror;
  Sweep alone = sweep;
  alone.paired = false;
  const Body own({alone}, mirror, {});
  const Mesh mesh = tube(sweep, how);
  add(sweep.paired ? name + ".L" : name, mesh, [&](const Vec3& p) { return own.bone_weights(p); });
  if (!sweep.paired) return;
  const auto other = [&](const Vec3& p) {
    const std::vector<double> left = own.bone_weights(mirrored(p));
    std::vector<double> right(left.size());
    for (size_t b = 0; b < left.size(); ++b) right[static_cast<size_t>(mirror[b])] = left[b];
    return right;
  };
  add(name + ".R", mirrored(mesh), other);
}

void make_flesh(Workshop& shop) {
  const Flesh& f = shop.flesh;
  if (shop.plan.style.make == Make::tubes) return add_tubes(shop);
  if (shop.plan.style.make == Make::pieces) return add_pieces(shop);
  const bool fingers = shop.plan.style.hand == Hand::fingers;
  const auto most = joined({&f.torso, &f.legs, &f.feet, &f.arms});
  add_surface(shop, "body", fingers ? joined({&most, &f.head}) : joined({&most, &f.hands, &f.head}), 0.02,
              shop.plan.style.vertices);
  if (fingers) add_hand_surface(shop);
}

void hide_flesh(Workshop& shop, size_t flesh_parts) {
  std::vector<bool> hidden(static_cast<size_t>(shop.plan.bone_count()), false);
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
  Workshop shop{plan, flesh, body, random, {}, {}};
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
