// Updates references to nodes by number when their content has moved to other nodes.
#pragma once
#include <cstdint>
#include <map>

#include "gltf/document_edit.h"

namespace focal {

// Maps old nodes to new ones.
struct MovedNodes {
  std::map<int64_t, int64_t> meshes;  // nodes whose mesh, with its weights, moved to another node
  std::map<int64_t, int64_t> joints;  // nodes whose role as a joint moved to another node
};

// Applied once to all references that focal knows: animations (weights, KHR_animation_pointer), VRM 0 and 1
// (humanoid, expressions, first person, spring bones, constraints).
void move_references(OrderedJson& root, const MovedNodes& moved);

}  // namespace focal
