// One finished character: mesh, skin, pose and landmarks.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "design.h"
#include "geometry.h"
#include "skeleton.h"

namespace creatures {

struct Landmark {
  std::string name;
  int triangle;
  Vec3 barycentric;
  int vertex;  // the corner nearest to the point
};

struct Character {
  std::string name;
  Skeleton skeleton;
  Mesh rest;
  std::vector<Influences> skin;
  Pose pose;
  std::vector<Vec3> posed;  // positions of the vertices in the pose
  std::vector<Landmark> landmarks;
};

// The same seed gives the same character, bit for bit.
Character make_character(const Family& family, const std::string& name, uint64_t seed);

}  // namespace creatures
