// Skin weights from bones alone, for skeletons without training characters.
#pragma once
#include <cstdint>
#include <vector>

#include "analysis/surface_analysis.h"
#include "mesh/ray_caster.h"

namespace focal {

struct Bone {
  int32_t joint = 0;  // that the bone belongs to
  Vector3 from, to;   // in the coordinates of the analysed surface
};

// vertices of the analysed surface x joints, each row of sum 1: heat of the nearest bone that is visible from
// a vertex inside the body, diffused along the surface, so that limbs that touch do not share it. I. Baran,
// J. Popović, "Automatic Rigging and Animation of 3D Characters", 2007. strength: of the heat relative to the
// diffusion; larger values give harder weights. Throws invalid_argument without bones.
RowMatrixf bone_heat_weights(const SurfaceAnalysis& analysis, const RayCaster& rays,
                             const std::vector<Bone>& bones, int32_t joint_count, const Execution& execution,
                             double strength = 1);

}  // namespace focal
