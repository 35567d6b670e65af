// glTF and GLB in: every triangle primitive of the shown scene as one triangle mesh in world coordinates.
//
// Taken: primitives in modes TRIANGLES, TRIANGLE_STRIP and TRIANGLE_FAN; float and 8/16-bit positions
// (KHR_mesh_quantization), sparse accessors, EXT_meshopt_compression, indices of any width or none.
// Morph targets stay at their base shape; images and materials are not looked at.
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "gltf/limits.h"
#include "mesh/scenery.h"
#include "mesh/triangle_mesh.h"

namespace focal {

struct GltfReadParams {
  GltfLimits limits;
  // Also read buffers from files beside the .gltf: regular files inside its folder, no links. read_gltf only.
  bool allow_external_files = false;
  // Positions that are not finite stay as they are, and an index out of range becomes -1, for prepare to leave out.
  bool lenient = false;
  // Also read meshes that KHR_node_visibility hides.
  bool hidden_too = false;
};

// Where a primitive of the file went in the merged mesh.
struct GltfPrimitive {
  int32_t mesh = -1, primitive = -1;  // indices in the file
  int32_t node = -1;                  // the first node of the scene that shows the mesh; -1: no node does
  int32_t first_vertex = 0, vertex_count = 0;
  int32_t first_triangle = 0, triangle_count = 0;
  Matrix4 world_transform = Matrix4::Identity();  // merged position = world_transform * position in the file
  // The node's place turns left into right: corners 1 and 2 of each triangle were swapped, so that triangles
  // stay counter-clockwise from outside.
  bool mirrored = false;
  bool is_scenery = false;  // set by callers: add_skin leaves its mesh and node as they are
};

struct GltfMesh {
  TriangleMesh mesh;                      // primitives one after the other, nodes depth first in scene order
  std::vector<GltfPrimitive> primitives;  // in the same order
  std::vector<MeshPiece> pieces;          // the triangles of each mesh, in the same order
  std::vector<std::string> hidden;        // nodes whose meshes were not read: KHR_node_visibility hides them
  std::vector<std::string> warnings;      // plain sentences: what was skipped or assumed
};

// The scene is the file's default, else all scenes; if that shows no mesh, all nodes, then all meshes are
// taken. A mesh shown several times comes once, as its first node shows it. A skinned mesh comes in its bind
// pose, placed in the world by its topmost joint (glTF ignores the node's own transform there). Nodes that KHR_node_visibility hides,
// and what is below them, are left out, unless they are all there is.
//
// Throws file_not_found, io; invalid_file (truncated or malformed); unsupported (required extension, external
// buffer, a limit); invalid_mesh (no triangles, NaN or infinite position, index out of range).
GltfMesh read_gltf(const std::filesystem::path& path, const GltfReadParams& params = {});
GltfMesh read_gltf_memory(std::span<const std::byte> bytes, const GltfReadParams& params = {});

}  // namespace focal
