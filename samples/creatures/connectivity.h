// A closed triangle mesh that can be changed edge by edge and stays closed and manifold.
#pragma once
#include <utility>
#include <vector>

#include "geometry.h"

namespace creatures {

class Connectivity {
 public:
  explicit Connectivity(const Mesh& mesh);

  std::vector<Vec3> positions;

  bool alive(int vertex) const { return !fans_[vertex].empty(); }
  int valence(int vertex) const { return static_cast<int>(fans_[vertex].size()); }
  std::vector<int> neighbours(int vertex) const;
  std::vector<std::pair<int, int>> edges() const;  // lower number first, sorted
  bool is_edge(int a, int b) const;
  // The vertex before a -> b and the one before b -> a.
  std::pair<int, int> opposite(int a, int b) const;

  int split(int a, int b, const Vec3& at);      // returns the new vertex
  bool collapse(int a, int b, const Vec3& at);  // b becomes a, unless that would fold or pinch the surface
  bool flip(int a, int b);                      // to the other diagonal, unless that would fold it
  bool move(int vertex, const Vec3& to);        // unless that would fold the surface
  Vec3 normal(int vertex) const;                // area-weighted, not normalised
  Mesh compact() const;

 private:
  Vec3 face_normal(const Triangle& t) const;
  int triangle_with(int a, int b) const;  // holding the directed edge
  void attach(int triangle);
  void detach(int triangle);
  bool turns_over(int vertex, const Vec3& at, int except) const;

  std::vector<Triangle> triangles_;
  std::vector<std::vector<int>> fans_;  // the triangles around each vertex
};

}  // namespace creatures
