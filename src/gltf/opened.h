// What a GltfDocument holds.
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
  std::optional<std::filesystem::path> folder, readable_folder;  // where it lies, and where it may read
  GltfContainer container;                                       // of bytes
  GltfView view;
  std::vector<std::string> uris;  // of buffers and images that lie beside it

  GltfBuffers buffers() const { return {view, container, params.limits, readable_folder}; }
};

struct GltfDocument::Edited {
  OrderedJsonDocument document;
  std::vector<std::byte> bin;  // takes the place of the BIN chunk, or becomes it; empty: as it was
};

// JOINTS_n and WEIGHTS_n of one primitive, for all n: per vertex the places in its skin's list of joints. Weights that are negative, NaN or
// infinite are counted and left out. Throws invalid_file (a joint that the skin does not have).
std::vector<std::vector<Influence>> skin_influences(const GltfView& view, GltfBuffers& buffers,
                                                    const GltfPrimitive& range, int64_t& invalid_weights);

// Of a primitive that is_posed: from its position in the file to the world, one a vertex.
std::vector<Matrix4> vertex_transforms(const GltfView& view, GltfBuffers& buffers,
                                       const GltfPrimitive& range);

}  // namespace focal
