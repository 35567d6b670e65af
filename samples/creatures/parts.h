// Pieces that make up a game character: tubes, boxes, sheets, each with its own skin.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "body.h"
#include "skeleton.h"

namespace creatures {

struct Part {
  std::string name;
  Mesh mesh;
  std::vector<Influences> skin;
};

// How a sweep becomes rings of vertices.
struct Tube {
  int sides = 8, rings = 4;
  int caps = 2;       // bands of a rounded cap, 0: flat
  double square = 0;  // 0: round, 1: a box where there are 4 sides
  bool open_start = false, open_end = false;
  double from = 0, to = 1;  // the stretch of the axis
};

Mesh tube(const Sweep& sweep, const Tube& how);
// Columns and rows of a sheet, point(u, v) for u and v from 0 to 1; it looks along du x dv.
Mesh sheet(int columns, int rows, const std::function<Vec3(double, double)>& point);
// Keeps the side where f is negative; the new border lies on the zero set.
Mesh clip(const Mesh& mesh, const std::function<double(const Vec3&)>& f);
Mesh mirrored(const Mesh& mesh);
void append(Mesh& mesh, const Mesh& more);
void drop_loose_vertices(Part& part);
// Every section, cap and thus the whole surface moves outwards.
Sweep inflated(Sweep sweep, double by);

// Non-negative weights of each bone at a point, not normalised.
using WeightField = std::function<std::vector<double>(const Vec3&)>;
WeightField rigid(int bone, int bone_count);
// The body's weights for these bones only; where it has none, all weight goes to the first.
WeightField ridden(const Body& body, std::vector<int> bones);
// Weights averaged over neighbours so many times; the strongest few stay.
std::vector<Influences> skin_mesh(const Mesh& mesh, const WeightField& weights, int rounds);

}  // namespace creatures
