// Transfers animations of one character to the skeleton of another.
#pragma once
#include <vector>

#include "mesh/animation.h"
#include "mesh/rig.h"

namespace focal {

// A rigged character whose clips are transferred. Its joints refer to nodes of the tree by name; joints of
// several skeletons may have the same name with a number, as GltfDocument::rig creates them.
struct ClipSource {
  const std::vector<Joint>& joints;  // bound in the character's coordinates
  const NodeTree& tree;
};

struct Retargeted {
  std::vector<JointKeys> joints;     // one per target joint
  std::vector<std::string> missing;  // target joints that the source lacks
};

// target: its joints have the same axes as the source's joints of the same names. target_rest: its joints in
// the rest pose of the training characters, for joints that are matched only by a convention and have other
// axes; may be empty. scale: of the target's lengths relative to the source's.
//
// Joints get the source's world rotations; translations in the source (a hip that rises, an animated foot)
// are scaled. Keys, their times and interpolation are kept wherever one node's keys determine the joint's
// transform relative to the joint above; else the joint is sampled at the keys of all nodes that move it.
// Among skeletons with the same names the one that the clip animates most is used.
Retargeted retarget(const ClipSource& source, const Clip& clip, const std::vector<Joint>& target,
                    const std::vector<Matrix4>& target_rest, double scale);

}  // namespace focal
