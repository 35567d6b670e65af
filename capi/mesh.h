// focal_mesh: the caller's triangles, the surface made of them, and the file they came from.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "context.h"
#include "gltf/document.h"
#include "handles.h"
#include "mesh/prepare.h"

namespace focal {

// What of a scene is not analysed.
struct LeftOut {
  int32_t reason = 0;  // focal_scenery
  std::string name;
  int64_t triangle_count = 0;
  bool is_whole_node = true;
};

// Of the caller's vertices and triangles.
struct MeshPart {
  uint64_t first_vertex = 0, vertex_count = 0, first_triangle = 0, triangle_count = 0;
};

struct MeshObject {
  using Handle = focal_mesh;
  static constexpr HandleType type = HandleType::mesh;

  std::shared_ptr<const MemoryBudget> memory_budget;  // of its context
  std::shared_ptr<const PreparedMesh> mesh;
  std::vector<float> positions;  // vertex_count x 3, as the caller may read them
  double mean_edge_length = 0, surface_area = 0;
  double load_seconds = 0, repair_seconds = 0;
  std::vector<std::string> warnings;  // of reading, then of preparing
  std::string name;                   // of the file it came from, for messages; or none
  std::shared_ptr<const GltfDocument>
      document;                           // the caller's glTF; null when there is none or it was not kept
  std::vector<GltfPrimitive> primitives;  // of that file
  std::vector<LeftOut> left_out;
  std::vector<MeshPart> parts;
};

}  // namespace focal
