// From rigged characters to a training set: one skeleton for all of them, landmarks that follow from it, and copies in other
// poses and proportions, so that one or a few characters stand for their category.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "model/training_set.h"

namespace focal {

struct RiggedMesh {
  std::shared_ptr<const PreparedMesh> mesh;
  Rig rig;                      // in the coordinates of mesh->source, one entry of influences a source vertex
  std::string file = {};        // its name, for messages; or none
  int64_t invalid_weights = 0;  // of the file: negative, NaN or infinite; they were left out of the rig
};

struct RiggedShapesParams {
  int32_t shapes = 16;     // in all, copies included; every character comes as it is too
  int32_t landmarks = 48;  // at most
  uint64_t seed = 0;
};

// The joints of the set are those that most of the characters have, by name (see match_teachers), and that move some vertex or carry such a joint:
// controls that only drive others are left out. Joints of one character that the set does not have give their weights to
// the nearest ancestor that it has. Throws invalid_argument (no character, or none with a vertex that a joint moves; see
// match_teachers).
TrainingSet training_set_of(const std::vector<RiggedMesh>& characters, const RiggedShapesParams& params = {},
                            const Execution& execution = {}, std::vector<std::string>* warnings = nullptr);

}  // namespace focal
