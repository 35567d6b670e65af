// The contents of a GltfDocument.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "gltf/buffers.h"
#include "gltf/document.h"
#include "gltf/json.h"
#include "gltf/view.h"

namespace focal {

struct GltfDocument::Opened {
  std::vector<std::byte> bytes;
  GltfReadParams params;
  std::optional<std::filesystem::path> folder,
      readable_folder;      // its folder, and the folder that it may read
  GltfContainer container;  // of bytes
  GltfView view;
  std::vector<std::string> uris;  // of buffers and images beside it

  GltfBuffers buffers() const { return {view, container, params.limits, readable_folder}; }
};

struct GltfDocument::Edited {
  OrderedJsonDocument document;
  std::vector<std::byte> bin;  // replaces or adds the BIN chunk; empty: unchanged
};

// JOINTS_n and WEIGHTS_n of one primitive, for all n: per vertex indices into its skin's list of joints.
// Weights that are negative, NaN or infinite are counted and skipped. Throws invalid_file (a joint that the
// skin does not have).
std::vector<std::vector<Influence>> skin_influences(const GltfView& view, GltfBuffers& buffers,
                                                    const GltfPrimitive& range, int64_t& invalid_weights);

// Of a primitive that is_posed: from positions in the file to the world, one transform per vertex.
std::vector<Matrix4> vertex_transforms(const GltfView& view, GltfBuffers& buffers,
                                       const GltfPrimitive& range);

}  // namespace focal
