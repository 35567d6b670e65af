// How alike two skeletons are, as Xu et al., "RigNet: Neural Rigging for Articulated Characters", 2020, measure it.
#pragma once
#include <vector>

#include "mesh/ray_caster.h"
#include "mesh/rig.h"

namespace focal_test {

struct SkeletonMetrics {
  // Chamfer distances: between joints, joints and the other's bones, bones; of the truth's longest side.
  double joints_to_joints = 0, joints_to_bones = 0, bones_to_bones = 0;
  // Joints that are matched one to one within half the body's thickness at the true joint: 2 m / (found + true), m / found,
  // m / true.
  double iou = 0, precision = 0, recall = 0;
};

// body: the surface that both skeletons are for, in their coordinates.
SkeletonMetrics compare_skeletons(const std::vector<focal::Joint>& found,
                                  const std::vector<focal::Joint>& truth, const focal::TriangleMesh& body);

}  // namespace focal_test
