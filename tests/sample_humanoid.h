// Sample humanoids as meshes, and with their landmarks.
#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>

#include "creatures/character.h"
#include "mesh/prepare.h"
#include "model/training_set.h"

namespace focal_test {

inline creatures::Character humanoid(uint64_t seed) {
  const auto& families = creatures::families();
  const auto family =
      std::find_if(families.begin(), families.end(), [](const auto& f) { return f.name == "humanoid"; });
  return creatures::make_character(*family, "humanoid", seed);
}

// The character's triangles between any places of its vertices.
inline focal::TriangleMesh mesh_at(const std::vector<creatures::Vec3>& positions,
                                   const creatures::Character& character) {
  focal::TriangleMesh mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(positions.size()), 3);
  for (size_t v = 0; v < positions.size(); ++v)
    mesh.positions.row(static_cast<Eigen::Index>(v)) = positions[v];
  mesh.triangles.resize(static_cast<Eigen::Index>(character.rest.triangles.size()), 3);
  for (size_t t = 0; t < character.rest.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      mesh.triangles(static_cast<Eigen::Index>(t), i) = character.rest.triangles[t][i];
  return mesh;
}

inline focal::TriangleMesh posed_mesh(const creatures::Character& character) {
  return mesh_at(character.posed, character);
}

inline focal::MarkedShape marked(const creatures::Character& character) {
  focal::MarkedShape shape{std::make_shared<focal::PreparedMesh>(focal::prepare(posed_mesh(character))), {}};
  for (const auto& mark : character.landmarks)
    shape.marks.push_back(focal::to_surface(*shape.mesh, {mark.triangle, mark.barycentric}));
  return shape;
}

}  // namespace focal_test
