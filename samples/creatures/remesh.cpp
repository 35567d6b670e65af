// From the lattice's triangles to well-shaped ones of the wanted sizes, on the same surface.
// M. Botsch, L. Kobbelt, "A Remeshing Approach to Multiresolution Modeling", 2004: split, collapse, flip, relax;
// with a size that varies over the surface, and projection onto the implicit body.
#include "remesh.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "connectivity.h"

namespace creatures {
namespace {

// The wanted edge length: the body's detail times a gentle random wave.
class SizeField {
 public:
  SizeField(const Body& body, Random& random) : body_(body) {
    for (Vec3* wave : {&first_, &second_})
      *wave = Vec3(random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-6, 6));
    phase_ = random.uniform(0, 6);
  }
  double operator()(const Vec3& p) const {
    const double wave = std::sin(first_.dot(p) + phase_) + std::sin(second_.dot(p) - phase_);
    return scale * body_.detail(p) * (1 + 0.12 * wave);
  }
  double scale = 1;

 private:
  const Body& body_;
  Vec3 first_, second_;
  double phase_;
};

double scale_for(const Mesh& mesh, const SizeField& size, int vertex_count) {
  // A triangle with the wanted edge l has the area sqrt(3)/4 l^2, and there are two triangles a vertex.
  double vertices = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const double l = size((a + b + c) / 3);
    vertices += 0.5 * (b - a).cross(c - a).norm() / (std::sqrt(3.0) / 2 * l * l);
  }
  return std::sqrt(vertices / vertex_count);
}

struct Remesher {
  Connectivity mesh;
  const Body& body;
  const SizeField& size;
  std::vector<double> wanted;  // edge length at each vertex

  double length(int a, int b) const { return (mesh.positions[a] - mesh.positions[b]).norm(); }
  double wanted_length(int a, int b) const { return 0.5 * (wanted[a] + wanted[b]); }

  void split_long() {
    for (const auto& [a, b] : mesh.edges()) {
      if (length(a, b) < 4.0 / 3 * wanted_length(a, b)) continue;
      mesh.split(a, b, body.project(0.5 * (mesh.positions[a] + mesh.positions[b])));
      wanted.push_back(wanted_length(a, b));
    }
  }

  void collapse_short() {
    for (const auto& [a, b] : mesh.edges()) {
      if (!mesh.alive(a) || !mesh.alive(b) || !mesh.is_edge(a, b)) continue;
      if (length(a, b) > 4.0 / 5 * wanted_length(a, b)) continue;
      const Vec3 at = 0.5 * (mesh.positions[a] + mesh.positions[b]);
      bool too_long = false;
      for (int end : {a, b})
        for (int v : mesh.neighbours(end))
          too_long |= (mesh.positions[v] - at).norm() > 4.0 / 3 * wanted_length(v, end);
      if (too_long) continue;
      mesh.collapse(a, b, at);
    }
  }

  void flip_to_six() {
    for (const auto& [a, b] : mesh.edges()) {
      if (!mesh.is_edge(a, b)) continue;
      const auto [c, d] = mesh.opposite(a, b);
      const auto off = [&](int v, int change) { return std::abs(mesh.valence(v) + change - 6); };
      const int before = off(a, 0) + off(b, 0) + off(c, 0) + off(d, 0);
      if (off(a, -1) + off(b, -1) + off(c, 1) + off(d, 1) < before) mesh.flip(a, b);
    }
  }

  void relax() {
    const std::vector<Vec3> old = mesh.positions;
    for (int v = 0; v < static_cast<int>(old.size()); ++v) {
      if (!mesh.alive(v)) continue;
      Vec3 centre = Vec3::Zero();
      double weight = 0;
      for (int w : mesh.neighbours(v)) {
        const double pull = 1 / (wanted[w] * wanted[w]);  // crowded neighbours must not push outwards
        centre += pull * old[w];
        weight += pull;
      }
      const Vec3 n = mesh.normal(v).normalized();
      const Vec3 step = centre / weight - old[v];
      mesh.move(v, body.project(old[v] + 0.6 * (step - n * n.dot(step))));
    }
  }

  void measure() {
    wanted.resize(mesh.positions.size());
    for (int v = 0; v < static_cast<int>(wanted.size()); ++v)
      if (mesh.alive(v)) wanted[v] = size(mesh.positions[v]);
  }
};

}  // namespace

Mesh remesh(const Mesh& mesh, const Body& body, int vertex_count, Random& random) {
  SizeField size(body, random);
  size.scale = scale_for(mesh, size, vertex_count);
  Remesher work{Connectivity(mesh), body, size, {}};
  constexpr int rounds = 5;
  for (int round = 0; round < rounds; ++round) {
    work.measure();
    work.collapse_short();
    work.split_long();
    work.flip_to_six();
    work.relax();
  }
  work.flip_to_six();
  work.relax();
  return work.mesh.compact();
}

}  // namespace creatures
