// Animations of one character for the skeleton that another one got.
#pragma once
#include <vector>

#include "mesh/animation.h"
#include "mesh/rig.h"

namespace focal {

// A rigged character whose clips are played on another one. Its joints name nodes of the tree; joints of several skeletons may be called
// alike but for a number, as GltfDocument::rig names them.
struct ClipSource {
  const std::vector<Joint>& joints;  // bound in the character's coordinates
  const NodeTree& tree;
};

struct Retargeted {
  std::vector<JointKeys> joints;     // one a target joint
  std::vector<std::string> missing;  // target joints that the source lacks
};

// target: whose joints have axes like the source's joints of the same names; target_rest: its joints in the rest pose of those it was
// learned from, for joints that are matched by a convention only and whose axes are others; may be empty. scale: of the target's
// lengths, the source's being 1.
//
// Joints turn in the world as the source's do; what the source moves besides (a hip that rises, a foot that is led) is moved by
// the same, scaled. Keys stay the source's, times and interpolation included, wherever one node's keys say how the joint stands to the
// joint above; else the joint is sampled at the keys of all nodes that move it. Of skeletons with the same names the one counts that the
// clip moves most.
Retargeted retarget(const ClipSource& source, const Clip& clip, const std::vector<Joint>& target,
                    const std::vector<Matrix4>& target_rest, double scale);

}  // namespace focal
