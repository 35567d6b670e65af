// What names nodes by their numbers, when what they stood for has moved to other nodes.
#pragma once
#include <cstdint>
#include <map>

#include "gltf/document_edit.h"

namespace focal {

// From old nodes to new ones.
struct MovedNodes {
  std::map<int64_t, int64_t> meshes;  // a mesh, with its weights, went to another node
  std::map<int64_t, int64_t> joints;  // a joint's part is another node's now
};

// Applied once to all references that focal knows: animations (weights, KHR_animation_pointer), VRM 0 and 1 (humanoid, expressions,
// first person, spring bones, constraints).
void move_references(OrderedJson& root, const MovedNodes& moved);

}  // namespace focal
