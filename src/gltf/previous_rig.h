// The skeleton that an earlier call put into a document makes way for the next one.
#pragma once
#include <cstddef>
#include <vector>

#include "gltf/document_edit.h"

namespace focal {

struct FormerRig {
  std::vector<size_t> nodes;  // of its joints and tips, out of the scene now
  std::vector<size_t> skins;  // no node uses them now
};

// Takes every "focal_skeleton" out of the scene, with its skins and with the animations that move its joints alone. One to which
// the user has hung something of his own (a mesh, a camera) stays.
FormerRig release_previous_rig(OrderedJson& root);

}  // namespace focal
