// Removes the skeleton of an earlier call from a document.
#pragma once
#include <cstddef>
#include <vector>

#include "gltf/document_edit.h"

namespace focal {

struct FormerRig {
  std::vector<size_t> nodes;  // of its joints and tips, no longer in the scene
  std::vector<size_t> skins;  // no longer used by a node
};

// Removes every "focal_skeleton" from the scene, with its skins and with the animations of its joints only.
// One to which the user has attached other nodes (a mesh, a camera) is kept.
FormerRig release_previous_rig(OrderedJson& root);

}  // namespace focal
