// A root joint on the ground, below the hips, as engines expect.
#pragma once
#include "skeleton/character_rig.h"

namespace focal {

// Adds a joint before all others as the parent of all roots: below the first root, at the height of the
// mesh's lowest vertex (y is up), with the mesh's orientation. It moves no vertex.
void add_ground_root(const std::string& name, const TriangleMesh& mesh, CharacterRig& character);

}  // namespace focal
