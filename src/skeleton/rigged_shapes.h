// Creates a training set from rigged characters: a common skeleton, landmarks derived from it, and copies in
// other poses and proportions, so that one or a few characters represent their category.
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
  Rig rig;                // in the coordinates of mesh->source, one entry of influences per source vertex
  std::string file = {};  // for messages; may be empty
  int64_t invalid_weights = 0;  // of the file: negative, NaN or infinite; not in the rig
};

struct RiggedShapesParams {
  int32_t shapes = 16;     // in total, copies included; every character is also included unchanged
  int32_t landmarks = 48;  // maximum number
  uint64_t seed = 0;
};

// The joints of the set are those that most of the characters have, by name (see match_teachers), and that
// move a vertex or have such a descendant: controls that only drive others are left out. The weights of a
// character's other joints go to the nearest ancestor in the set. Throws invalid_argument (no character, or
// none with a vertex that a joint moves; see match_teachers).
TrainingSet training_set_of(const std::vector<RiggedMesh>& characters, const RiggedShapesParams& params = {},
                            const Execution& execution = {}, std::vector<std::string>* warnings = nullptr);

}  // namespace focal
