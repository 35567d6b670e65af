// Animations that a skeleton takes over from another character's file, and those of its own file that stop playing.
#pragma once
#include <string>
#include <vector>

#include "gltf/output_file.h"
#include "skeleton/character_rig.h"
#include "skeleton/retarget.h"

namespace focal {

// The character's clips for the joints of the rig. scale: of the rig's lengths, the character's being 1. Throws invalid_argument: no skin,
// no joint in common.
std::vector<JointAnimation> animations_for(const CharacterRig& rig, const SourceFile& character, double scale,
                                           std::vector<std::string>& warnings);

// The skeleton of a mesh's own file, if it has one that can be read: what is wrong with it is no reason not to give it another. file may
// be null.
std::optional<Rig> own_rig(const SourceFile* file);

// Warns of clips of the mesh's own file that move a skeleton which no mesh follows once it has these joints.
void warn_of_idle_clips(const SourceFile* file, const std::vector<Joint>& joints,
                        std::vector<std::string>& warnings);

// The joints of the mesh's own file that the new ones stand for; none where it has no skeleton.
std::vector<ReplacedJoint> replaced_joints(const SourceFile* file, const std::vector<Joint>& joints);

}  // namespace focal
