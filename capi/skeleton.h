// focal_skeleton: joints and skin weights for one mesh.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "detection.h"
#include "handles.h"
#include "skeleton/rig_transfer.h"
#include "skeleton/verdict.h"

namespace focal {

struct SkeletonObject {
  using Handle = focal_skeleton;
  static constexpr HandleType type = HandleType::skeleton;

  std::shared_ptr<const ContextObject> context;
  std::shared_ptr<const MeshObject> mesh;
  std::shared_ptr<const DetectionObject> detection;  // null: a skeleton that was there
  CharacterRig rig;
  bool keeps_joints = false;  // those of the mesh's own file, which gets other weights only
  Verdict verdict = Verdict::check;
  double quality = 0;
  uint32_t guessed_joints = 0;
  std::vector<JointAnimation> animations;
  std::vector<Matrix4> shown_pose;  // per joint, as the file shows them; empty: in the pose of the mesh
};

}  // namespace focal
