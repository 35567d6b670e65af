// Where the parts of one game character are made.
#include "shop.h"

#include <algorithm>
#include <utility>

#include "design.h"
#include "polygonise.h"
#include "remesh.h"

namespace creatures::game {

Tube Shop::usual() const {
  return {.sides = sides,
          .rings = std::clamp(sides / 2, 2, 7),
          .caps = sides < 7    ? 1
                  : sides < 12 ? 2
                               : 3,
          .square = square};
}

void Shop::add(const std::string& name, Mesh mesh, const WeightField& weights, int rounds) {
  if (mesh.triangles.empty()) return;
  std::vector<Influences> skin = skin_mesh(mesh, weights, rounds);
  parts.push_back({name, std::move(mesh), std::move(skin)});
}

void Shop::add_rigid(const std::string& name, const Mesh& mesh, int bone, bool paired) {
  add(paired ? name + ".L" : name, mesh, rigid(bone, bone_count()));
  if (paired) add(name + ".R", mirrored(mesh), rigid(skeleton.mirror[bone], bone_count()));
}

void Shop::add_tube(const std::string& name, const Sweep& sweep, const Tube& how) {
  const std::vector<int>& mirror = skeleton.mirror;
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

void Shop::add_surface(const std::string& name, const std::vector<Sweep>& sweeps, double cell, int count) {
  const Body own(sweeps, skeleton.mirror, random_asymmetry(random, 0.001));
  const int rounds = count > 2000 ? 4 : count > 700 ? 1 : 0;
  add(
      name, surface_of(own, cell, count, random), [&](const Vec3& p) { return body.bone_weights(p); },
      rounds);
}

void Shop::add_paired_surface(const std::string& name, std::vector<Sweep> sweeps, double cell, int count) {
  for (Sweep& s : sweeps) s.paired = false;
  const Mesh mesh = surface_of(Body(sweeps, skeleton.mirror, {}), cell, count, random);
  const auto weights = [&](const Vec3& p) { return body.bone_weights(p); };
  add(name + ".L", mesh, weights, 1);
  add(name + ".R", mirrored(mesh), weights, 1);
}

Mesh surface_of(const Body& body, double cell, int count, Random& random) {
  const Vec3 shift(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(random.uniform(0, 3), Vec3(0.2, 0.5, 1).normalized()));
  return remesh(polygonise(body, cell, turn, shift), body, count, random);
}

std::vector<Sweep> joined(std::initializer_list<const std::vector<Sweep>*> groups) {
  std::vector<Sweep> all;
  for (const auto* g : groups) all.insert(all.end(), g->begin(), g->end());
  return all;
}

Sweep segment(const Vec3& from, const Vec3& to, std::vector<Section> sections, std::array<int, 3> bones,
              double softness, double blend) {
  return {.from = from,
          .to = to,
          .front = Vec3::UnitZ(),
          .sections = std::move(sections),
          .start_cap = 0,
          .end_cap = 0,
          .bones = {{bones[0]}, {bones[1], 0.0, softness}, {bones[2], 1.0, softness}},
          .blend = blend,
          .paired = true};
}

void cap_round(Sweep& s, double start, double end) {
  s.start_cap = start * s.sections.front().side;
  s.end_cap = end * s.sections.back().side;
}

}  // namespace creatures::game
