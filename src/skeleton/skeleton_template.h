// A hand-written skeleton over hand-marked landmarks: the landmarks determine the position of each joint.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "skeleton/character_rig.h"
#include "skeleton/fixed_joints.h"

namespace focal {

struct TemplateJoint {
  std::string name = {}, parent = {};  // parent: the name of a joint before it; empty: a root
  // One of these defines its position: the mean over landmarks of the centres of the cross-sections below
  // them; the mean of the landmarks themselves; or a point on the line between two joints or landmarks.
  std::vector<std::string> centre = {}, surface = {}, between = {};
  double share = 0.5;                // position from the first to the second of `between`, 0..1
  std::string tip = {};              // the landmark at its end; empty: the far end of the part that it moves
  std::optional<Vector3> rest = {};  // direction of its bone in the rest pose, in the mesh's coordinates
};

struct SkeletonTemplate {
  std::vector<TemplateJoint> joints;
  bool symmetric = false;  // see make_symmetric
};

// Throws invalid_argument (a name that is empty, duplicate or unknown, none or several of the three
// positions, cyclic positions).
void check_template(const SkeletonTemplate& skeleton, const std::vector<std::string>& landmarks);

// Joints are inside the body; those whose landmarks are all absent are at their parents, with a warning.
// Weights are those of bone heat. A joint's y axis is along its bone. fixed: in the coordinates of
// mesh->source. Throws what check_template throws, and invalid_argument (a detection without an analysis).
CharacterRig rig_by_template(const SkeletonTemplate& skeleton, const Detection& detection,
                             const Execution& execution, int32_t influences = max_influences,
                             const FixedJoints& fixed = {});

}  // namespace focal
