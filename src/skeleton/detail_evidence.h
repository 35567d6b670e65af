// Evidence that a mesh has the parts of some joints: a mitten has no fingers to place them in.
#pragma once
#include <vector>

#include "skeleton/character_rig.h"

namespace focal {

// Distance along the surface from the end of a chain of joints to the next one, relative to the length of
// both chains, and relative to the same on the training shapes; the median of the chains. About 1 for a hand
// with fingers, near 0 where they are fused. 1 where it is unknown.
double median_separateness(const Detection& part, const CharacterRig& rig);

// Mean |log| of the bones' lengths relative to the reference: how far the joints differ from the training
// shapes.
double bone_strain(const std::vector<Vector3>& reference, const CharacterRig& rig);

}  // namespace focal
