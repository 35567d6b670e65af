// From the joints of a rig to those of the skins of the file that it was read from.
#pragma once
#include <span>

#include "gltf/document_edit.h"
#include "gltf/reader.h"
#include "mesh/rig.h"

namespace focal {

// Of the node that shows the primitive; null when it has none, or the primitive is scenery.
OrderedJson* skin_of(OrderedJson& root, const GltfPrimitive& primitive);

// The rig with the influences of each primitive's vertices in the numbers of its own skin. What a joint moves that the skin lacks goes
// to the nearest joint above it that the skin has; where there is none, the other joints of the vertex share it. Joints of the result: as many as the
// largest of these skins has.
Rig in_numbers_of_skins(OrderedJson& root, std::span<const GltfPrimitive> primitives, const Rig& rig);

}  // namespace focal
