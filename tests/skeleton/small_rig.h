// Sample humanoids with their rigs, and a small model learned of one.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <vector>

#include "creatures/character.h"
#include "landmarks/model_parts.h"
#include "landmarks/train.h"
#include "skeleton/rigged_shapes.h"

namespace focal_test {

using namespace focal;

inline const Execution execution = [] {
  Execution two;
  two.thread_count = 2;
  return two;
}();

inline creatures::Character humanoid(uint64_t seed) {
  const auto& families = creatures::families();
  const auto family =
      std::find_if(families.begin(), families.end(), [](const auto& f) { return f.name == "humanoid"; });
  return creatures::make_character(*family, "humanoid", seed);
}

inline std::shared_ptr<const focal::PreparedMesh> mesh_of(const std::vector<creatures::Vec3>& positions,
                                                          const creatures::Character& from) {
  TriangleMesh mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(positions.size()), 3);
  for (size_t v = 0; v < positions.size(); ++v) mesh.positions.row(v) = positions[v];
  mesh.triangles.resize(static_cast<Eigen::Index>(from.rest.triangles.size()), 3);
  for (size_t t = 0; t < from.rest.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) mesh.triangles(t, i) = from.rest.triangles[t][i];
  return std::make_shared<const PreparedMesh>(prepare(std::move(mesh)));
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
          .spoiled_copies = 0,
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
