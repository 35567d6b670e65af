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

// A run of vertices and triangles that becomes a mesh node of its own.
struct Piece {
  std::string name;
  int vertices, triangles;
};

struct Character {
  std::string name;
  Skeleton skeleton;
  Mesh rest;
  std::vector<Influences> skin;
  Pose pose;
  std::vector<Vec3> posed;  // positions of the vertices in the pose
  std::vector<Landmark> landmarks;
  std::vector<Piece> pieces = {};  // in order and without gaps; empty: one mesh
};

// Puts the character into a random pose, on the same ground as at rest.
void pose_character(Character& made, const std::vector<Freedom>& freedoms, Random& random);
// Finds the anchors' places on the body, and on the mesh what is nearest to them.
void add_landmarks(Character& made, const Body& body, const std::vector<Anchor>& anchors);

// The same seed gives the same character, bit for bit.
Character make_character(const Family& family, const std::string& name, uint64_t seed);

}  // namespace creatures
