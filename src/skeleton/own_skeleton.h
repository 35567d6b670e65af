// Skin weights for an existing skeleton: the caller's joints are unchanged, the body determines what each of
// them moves.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "skeleton/character_rig.h"

namespace focal {

struct OwnSkeleton {
  std::vector<Joint> joints;  // in the coordinates of mesh->source, parents first
  std::vector<char> moves;    // per joint: 0: it moves no vertex (a pole, a target, a control)
  // Per joint the end of its bone; nothing: computed from skeleton and body.
  std::vector<std::optional<Vector3>> tip;
};

// The joints of a rig, unchanged; those that are no vertex's main joint with at least a third of its weight
// move no vertex, unless this holds for all.
OwnSkeleton own_skeleton_of(const Rig& rig);

// Weights by bone heat on the analysed surface; small separate parts attached to a bone are rigid (see
// part_weights.h). influences: maximum per vertex, 1 to 8. A warning names joints outside the body. Throws
// invalid_argument (no joint, none that moves vertices), cancelled.
CharacterRig weights_for(const OwnSkeleton& skeleton, std::shared_ptr<const PreparedMesh> mesh,
                         int32_t influences, const Execution& execution);

}  // namespace focal
