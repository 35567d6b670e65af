// Skin weights for a skeleton that is there already: the caller's joints stay, the body says what each of them moves.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "skeleton/character_rig.h"

namespace focal {

struct OwnSkeleton {
  std::vector<Joint> joints;  // in the coordinates of mesh->source, parents first
  std::vector<char> moves;    // per joint: 0: it moves no vertex (a pole, a target, a control)
  std::vector<std::optional<Vector3>>
      tip;  // per joint: where its bone ends; nothing: it follows from skeleton and body
};

// The joints of a rig as they are; those that are no vertex's main joint with a third of its weight there move none here, unless none has any.
OwnSkeleton own_skeleton_of(const Rig& rig);

// Weights by bone heat on the analysed surface, small separate parts that ride on a bone rigid (see part_weights.h). influences: of one
// vertex at most, 1 to 8. A warning names joints that lie outside the body. Throws invalid_argument (no joint, none that moves
// anything), cancelled.
CharacterRig weights_for(const OwnSkeleton& skeleton, std::shared_ptr<const PreparedMesh> mesh,
                         int32_t influences, const Execution& execution);

}  // namespace focal
