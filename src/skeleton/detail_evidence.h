// Whether a mesh shows what a part's joints are for: a mitten has no fingers to place them in.
#pragma once
#include <vector>

#include "skeleton/character_rig.h"

namespace focal {

// How far apart along the surface the end of a chain of joints lies from the next one, over the length of both chains, and over the
// same on the training shapes; the median of the chains. About 1 for a hand with fingers, near 0 where they are one. 1 where nothing
// is known of it.
double median_separateness(const Detection& part, const CharacterRig& rig);

// Mean |log| of the bones' lengths, each over that of the reference: how far the joints found are from any the training shapes have.
double bone_strain(const std::vector<Vector3>& reference, const CharacterRig& rig);

}  // namespace focal
