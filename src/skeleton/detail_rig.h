// The second analysis of parts with many short bones: each is cut out of the mesh's own triangles and
// analysed on its own, and its joints and weights replace those of the whole-body rig.
#pragma once
#include "skeleton/character_rig.h"

namespace focal {

// rig: of this detection, with the influences of the source vertices.
void refine_details(const Detection& detection, int32_t influences, CharacterRig& rig,
                    const Execution& execution);

}  // namespace focal
