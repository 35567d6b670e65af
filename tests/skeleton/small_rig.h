// Sample humanoids with their rigs, and a small model learned of one.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <vector>

#include "landmarks/train.h"
#include "model/landmark_model.h"
#include "sample_humanoid.h"
#include "skeleton/rigged_shapes.h"

namespace focal_test {

using namespace focal;

inline const Execution execution = [] {
  Execution two;
  two.thread_count = 2;
  return two;
}();

inline std::shared_ptr<const focal::PreparedMesh> mesh_of(const std::vector<creatures::Vec3>& positions,
                                                          const creatures::Character& from) {
  return std::make_shared<const PreparedMesh>(prepare(mesh_at(positions, from)));
}

inline focal::RiggedMesh rigged(const creatures::Character& from) {
  RiggedMesh result{mesh_of(from.rest.positions, from), {}};
  for (const auto& joint : from.skeleton.joints) {
    Joint one{joint.name, joint.parent, Matrix4::Identity()};
    one.bind.topRightCorner<3, 1>() = joint.rest;
    result.rig.joints.push_back(one);
  }
  for (const auto& skin : from.skin) {
    std::vector<Influence> influences;
    for (int k = 0; k < creatures::max_influences; ++k)
      influences.push_back({skin.joints[k], static_cast<float>(skin.weights[k])});
    result.rig.influences.push_back(heaviest(influences));
  }
  return result;
}

inline focal::TrainParams small() {
  return {.eigenpair_count = 80,
          .tree_count = 10,
          .proxy_vertices = 1500,
          .augmented_copies = 0,
          .learns_confidence = false};
}

// Learned of one humanoid in eight poses, once a program.
inline std::shared_ptr<const focal::LandmarkModel> rig_model() {
  static const auto one = [] {
    const TrainingSet set = training_set_of({rigged(humanoid(1))}, {.shapes = 8, .landmarks = 40});
    return std::make_shared<const LandmarkModel>(train(set, small(), execution));
  }();
  return one;
}

}  // namespace focal_test
