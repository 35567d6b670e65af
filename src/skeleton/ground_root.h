// A root joint on the ground, as engines expect one below the hips.
#pragma once
#include "skeleton/character_rig.h"

namespace focal {

// One more joint before all others and above all roots: below the first root, at the height of the mesh's lowest vertex (y is up), turned
// as the mesh is. It moves no vertex.
void add_ground_root(const std::string& name, const TriangleMesh& mesh, CharacterRig& character);

}  // namespace focal
