// Where the parts of one game character are made.
#pragma once
#include <initializer_list>
#include <string>
#include <vector>

#include "parts.h"
#include "random.h"

namespace creatures::game {

enum class Make { skin, pieces, tubes };  // one blended surface, some of them, or a tube a limb

struct Shop {
  const Skeleton& skeleton;
  const Body& body;  // all of the flesh
  Random& random;
  int sides, vertices;  // of tubes, of one whole surface
  double square;        // of tubes
  std::vector<Part> parts = {};

  int bone_count() const { return static_cast<int>(skeleton.joints.size()); }
  bool chance(double share) { return random.uniform(0, 1) < share; }
  Tube usual() const;  // as many sides as the style wants
  void add(const std::string& name, Mesh mesh, const WeightField& weights, int rounds = 0);
  // The mesh is of the left side or the middle; `bone` is the left one, and takes the whole part.
  void add_rigid(const std::string& name, const Mesh& mesh, int bone, bool paired);
  // With the weights of the sweep's own bones, on both sides if it is paired.
  void add_tube(const std::string& name, const Sweep& sweep, const Tube& how);
  // One closed surface around the sweeps, with the weights of the flesh.
  void add_surface(const std::string& name, const std::vector<Sweep>& sweeps, double cell, int count);
  // Of one side's sweeps, made once and mirrored.
  void add_paired_surface(const std::string& name, std::vector<Sweep> sweeps, double cell, int count);
};

// A turned lattice of its own, then about so many vertices.
Mesh surface_of(const Body& body, double cell, int count, Random& random);
std::vector<Sweep> joined(std::initializer_list<const std::vector<Sweep>*> groups);
// A stretch of a limb that passes smoothly from the bone before it to its own and to the one after it.
Sweep segment(const Vec3& from, const Vec3& to, std::vector<Section> sections, std::array<int, 3> bones,
              double softness, double blend);
// Caps as shares of the half widths at both ends.
void cap_round(Sweep& sweep, double start, double end);

}  // namespace creatures::game
