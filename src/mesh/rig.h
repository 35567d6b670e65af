// Skeleton and skin: joints, and their weights for every vertex.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "base/matrix.h"

namespace focal {

struct Joint {
  std::string name;
  int32_t parent = -1;                 // index of a joint before it; -1: a root
  Matrix4 bind = Matrix4::Identity();  // from the joint's own coordinates to the mesh's
  int32_t node = -1;                   // of the source file
};

struct Influence {
  int32_t joint = 0;
  float weight = 0;
};
// Largest weight first, sum 1, no joint twice; all weights 0: no joint moves the vertex.
inline constexpr int max_influences = 4;
using VertexInfluences = std::array<Influence, max_influences>;

struct Rig {
  std::vector<Joint> joints;
  std::vector<VertexInfluences> influences;  // one per vertex
  // Further influences where more than max_influences joints may move a vertex: one entry per vertex, the sum
  // of both is 1.
  std::vector<VertexInfluences> more = {};  // empty: none
};

// The largest of any number of influences, scaled to sum 1; influences of one joint are added first.
VertexInfluences heaviest(std::span<const Influence> influences);
std::vector<Influence> heaviest(std::span<const Influence> influences, size_t most);

// Linear blend skinning: each position is moved by the weighted mean of its joints' transforms (one per
// joint). Vertices without a joint are not moved.
MatrixX3 skinned(const MatrixX3& positions, const std::vector<VertexInfluences>& influences,
                 const std::vector<Matrix4>& transforms);

}  // namespace focal
