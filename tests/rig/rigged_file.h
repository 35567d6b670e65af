// A character with its own skeleton, read from a file.
#pragma once
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "base/atomic_file.h"
#include "gltf/one_call.h"
#include "mesh/prepare.h"
#include "skeleton/rigged_shapes.h"

namespace focal_test {

inline focal::RiggedMesh read_rig(const std::filesystem::path& file) {
  const auto bytes = focal::read_file(file);
  focal::GltfMesh mesh = focal_test::read_gltf_memory(bytes);
  auto rig = focal_test::read_gltf_rig(bytes, mesh.primitives);
  if (!rig) throw std::runtime_error(file.string() + " has no skin");
  return {std::make_shared<const focal::PreparedMesh>(focal::prepare(std::move(mesh.mesh))), std::move(*rig)};
}

}  // namespace focal_test
