// Skeleton and skin: joints, and how far each of them moves every vertex.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "base/matrix.h"

namespace focal {

struct Joint {
  std::string name;
  int32_t parent = -1;                 // comes before it; -1: a root
  Matrix4 bind = Matrix4::Identity();  // from the joint's own coordinates to those of the mesh
  int32_t node = -1;                   // of the file that it was read from
};

struct Influence {
  int32_t joint = 0;
  float weight = 0;
};
// Heaviest first, sum 1, no joint twice; all weights 0: nothing moves the vertex.
inline constexpr int max_influences = 4;
using VertexInfluences = std::array<Influence, max_influences>;

struct Rig {
  std::vector<Joint> joints;
  std::vector<VertexInfluences> influences;  // one a vertex
  // What comes after these where more than max_influences joints may move a vertex: one a vertex, both together have sum 1.
  std::vector<VertexInfluences> more = {};  // empty: nothing does
};

// The heaviest of any number of influences, scaled to sum 1; of one joint they are added up.
VertexInfluences heaviest(std::span<const Influence> influences);
std::vector<Influence> heaviest(std::span<const Influence> influences, size_t most);

// Linear blend skinning: each position moved by the mean of its joints' transforms (one a joint). Vertices without a joint stay.
MatrixX3 skinned(const MatrixX3& positions, const std::vector<VertexInfluences>& influences,
                 const std::vector<Matrix4>& transforms);

}  // namespace focal
