// A character with its own skeleton, read from a file.
#pragma once
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "gltf/document.h"
#include "mesh/prepare.h"
#include "skeleton/rigged_shapes.h"

namespace focal_test {

inline focal::RiggedMesh read_rig(const std::filesystem::path& file) {
  const focal::GltfDocument document = focal::GltfDocument::open(file);
  focal::GltfMesh mesh = document.mesh();
  auto rig = document.rig(mesh.primitives);
  if (!rig) throw std::runtime_error(file.string() + " has no skin");
  return {std::make_shared<const focal::PreparedMesh>(focal::prepare(std::move(mesh.mesh))), std::move(*rig)};
}

}  // namespace focal_test
