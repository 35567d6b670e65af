// A file read or written by one call, as most tests want it.
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "gltf/document.h"

namespace focal_test {

inline std::vector<std::byte> copy_of(std::span<const std::byte> bytes) {
  return {bytes.begin(), bytes.end()};
}

inline focal::GltfMesh read_gltf(const std::filesystem::path& path,
                                 const focal::GltfReadParams& params = {}) {
  return focal::GltfDocument::open(path, params).mesh();
}

inline focal::GltfMesh read_gltf_memory(std::span<const std::byte> bytes,
                                        const focal::GltfReadParams& params = {}) {
  return focal::GltfDocument(copy_of(bytes), params).mesh();
}

inline std::optional<focal::Rig> read_gltf_rig(std::span<const std::byte> bytes,
                                               std::span<const focal::GltfPrimitive> primitives,
                                               int64_t* invalid_weights = nullptr,
                                               const focal::GltfLimits& limits = {}) {
  return focal::GltfDocument(copy_of(bytes), {.limits = limits}).rig(primitives, invalid_weights);
}

inline focal::GltfAnimations read_gltf_animations(std::span<const std::byte> bytes,
                                                  const focal::GltfLimits& limits = {}) {
  return focal::GltfDocument(copy_of(bytes), {.limits = limits}).animations();
}

inline std::vector<std::byte> add_skin(std::span<const std::byte> bytes,
                                       std::vector<focal::GltfPrimitive> primitives,
                                       const focal::GltfRig& rig, const focal::GltfLimits& limits = {}) {
  focal::GltfDocument document(copy_of(bytes), {.limits = limits});
  document.add_skin(primitives, rig);
  return document.bytes();
}

inline std::vector<std::byte> add_landmarks(std::span<const std::byte> bytes,
                                            std::span<const focal::GltfPrimitive> primitives,
                                            std::span<const focal::GltfLandmark> landmarks,
                                            const focal::GltfLimits& limits = {}) {
  focal::GltfDocument document(copy_of(bytes), {.limits = limits});
  document.add_landmarks(primitives, landmarks);
  return document.bytes();
}

}  // namespace focal_test
