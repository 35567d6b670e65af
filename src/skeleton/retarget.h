// Animations of one character for the skeleton that another one got.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "mesh/rig.h"

namespace focal {

// Where the joints of a character are over time: by name, to its coordinates, one a time.
using JointTracks = std::map<std::string, std::vector<Matrix4>>;

// source: the skeleton in its bind pose, of which the tracks are; target: whose joints have axes like the source's joints of
// the same names. scale: of the target's lengths, the source's being 1. Joints turn in the world as the source's do; what the
// source moves besides (a hip that rises, a foot that is led) is moved by the same, scaled.
std::vector<JointKeys> retarget(const std::vector<Joint>& source, const JointTracks& tracks,
                                const std::vector<Joint>& target, double scale);

}  // namespace focal
