// One glTF file: opened and checked once, read and written through this.
#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gltf/limits.h"
#include "mesh/animation.h"
#include "mesh/landmark_status.h"
#include "mesh/rig.h"
#include "mesh/scenery.h"
#include "mesh/triangle_mesh.h"

namespace focal {

struct GltfReadParams {
  GltfLimits limits;
  // Also read buffers from files beside the .gltf: regular files inside its folder, no links.
  bool allow_external_files = false;
  // Positions that are not finite stay as they are, an index out of range becomes -1, for prepare to leave out; empty parts are
  // left out.
  bool lenient = false;
  // Also read meshes that KHR_node_visibility hides.
  bool hidden_too = false;
};

// Where a primitive of the file went in the merged mesh.
struct GltfPrimitive {
  int32_t mesh = -1, primitive = -1;  // indices in the file
  int32_t node = -1;                  // the node of the scene that shows it; -1: no node does
  int32_t first_vertex = 0, vertex_count = 0;
  int32_t first_triangle = 0, triangle_count = 0;
  Matrix4 world_transform = Matrix4::Identity();  // merged position = world_transform * position in the file
  // The node's place turns left into right: corners 1 and 2 of each triangle were swapped, so that triangles
  // stay counter-clockwise from outside.
  bool mirrored = false;
  bool is_scenery = false;  // set by callers: add_skin leaves its mesh and node as they are
  int32_t skin = -1;        // that moves it
  int32_t joint = -1;       // without a skin: the node of the joint that it hangs on
  bool is_posed = false;    // its joints place each vertex for itself, and world_transform is not used
};

struct GltfMesh {
  TriangleMesh mesh;                      // primitives one after the other, nodes depth first in scene order
  std::vector<GltfPrimitive> primitives;  // in the same order
  std::vector<MeshPiece> pieces;          // the triangles of each instance of a mesh, in the same order
  std::vector<std::string> hidden;        // nodes whose meshes were not read: KHR_node_visibility hides them
  std::vector<std::string> warnings;      // plain sentences: what was skipped or assumed
};

struct GltfAnimations {
  NodeTree tree;
  std::vector<Clip> clips;            // those that move something
  std::vector<std::string> warnings;  // channels that are left out
};

struct GltfLandmark {
  std::string name;
  SurfacePoint point;                             // on the merged mesh; triangle -1: none
  Vector3 position = Vector3::Zero();             // world coordinates
  double confidence = 1;                          // 0..1
  LandmarkStatus status = LandmarkStatus::found;  // an absent one gets no node
};

// A joint of the file that a new one stands for, and where it is bound.
struct ReplacedJoint {
  int32_t node = -1;
  Matrix4 bind = Matrix4::Identity();
};

struct GltfRig {
  const Rig* rig = nullptr;  // on the merged mesh: bind matrices rigid, one entry of influences a vertex
  std::vector<Vector3>
      tips;  // per joint where its part ends, world coordinates; a leaf joint gets a node there. Or none
  std::vector<Matrix4> pose =
      {};  // where the joints stand in the file; none: as bound, so that the mesh looks as it is
  std::vector<JointAnimation> animations =
      {};                              // added to those of the file; names that are taken get a number
  const TriangleMesh* mesh = nullptr;  // the merged mesh; needed where a primitive is mirrored
  // Per joint. What hangs on the replaced one hangs on the new one, and what refers to it refers to the new one. Or none.
  std::vector<ReplacedJoint> replaces = {};
};

// The file is kept as it is, beside a typed view of it. Copies share both. Reading is thread-safe.
class GltfDocument {
 public:
  // folder: of the files beside it, which `allow_external_files` lets it read.
  // Throws invalid_file (truncated or malformed), unsupported (required extension, a limit).
  explicit GltfDocument(std::vector<std::byte> bytes, const GltfReadParams& params = {},
                        std::optional<std::filesystem::path> folder = std::nullopt);
  // Also throws file_not_found, io.
  static GltfDocument open(const std::filesystem::path& path, const GltfReadParams& params = {});
  GltfDocument(const GltfDocument&);
  GltfDocument(GltfDocument&&) noexcept;
  GltfDocument& operator=(GltfDocument&&) noexcept;
  ~GltfDocument();

  bool is_binary() const;

  // Every triangle primitive of the shown scene as one mesh in world coordinates. Taken: modes TRIANGLES, TRIANGLE_STRIP and
  // TRIANGLE_FAN; float and 8/16-bit positions (KHR_mesh_quantization), sparse accessors, EXT_meshopt_compression, indices of any
  // width or none; morph targets with the weights that the file shows. Images and materials are not looked at.
  //
  // The scene is the file's default, else all scenes; if that shows no mesh, all nodes, then all meshes are taken. Each instance of a
  // mesh comes. A skinned mesh comes in its bind pose, placed in the world by its topmost joint (glTF ignores the node's own transform
  // there); in the file's pose where the bind pose has all joints in one place. A mesh that hangs on a joint stands where the bind
  // pose has that joint. Nodes that KHR_node_visibility hides, and what is below them, are left out, unless they are all there is.
  //
  // Throws invalid_file; unsupported (external buffer, a limit); invalid_mesh (no triangles, NaN or infinite position, index out of
  // range); file_not_found, io (a buffer beside the file).
  GltfMesh mesh() const;

  // All skins that the primitives wear make one skeleton; bind matrices lead to the merged mesh's coordinates, and joints have names
  // that differ. What hangs on a joint is moved by it alone. Nothing without a skin. Weights that are negative, NaN or infinite count as
  // 0; invalid_weights, where given, gets their number.
  // Throws what mesh() throws; invalid_file (a weight of a joint that is not there, a bind matrix without an inverse).
  std::optional<Rig> rig(std::span<const GltfPrimitive> primitives, int64_t* invalid_weights = nullptr) const;

  // Of nodes: translation, rotation, scale. Throws what mesh() throws.
  GltfAnimations animations() const;

  // Adds a skeleton and skin weights for every mesh that the primitives show: a scene root "focal_skeleton" with the joints below it,
  // their places and rotations those of the bind matrices. Meshes that had a skin get this one; a node that may not carry a skin (it has
  // a place or a parent, or is animated) hands its mesh to a new scene root of its name, and what refers to the mesh through the node
  // goes along; each instance of a mesh gets its own. Where a node mirrors, the triangles of the file are turned. What an earlier call
  // put in is replaced. Primitives that are marked as scenery stay as they are; a mesh must be scenery as a whole. A vertex without
  // weights is moved by the first joint. `primitives` are those of mesh(), and say afterwards where things are now. Everything else
  // stays. Data goes into the BIN chunk, or into a data: URI in a .gltf.
  // Throws invalid_argument (a rig of another mesh, more than 65,536 joints, not finite).
  void add_skin(std::span<GltfPrimitive> primitives, const GltfRig& rig);

  // Other weights for the primitives that have a skin; nodes, skins and bind matrices stay (but where bind matrices make
  // no shape, the primitive is written as it is shown, and has a copy of its skin that is bound so). rig: of rig() with other influences. What a
  // joint moves that a primitive's skin lacks goes to the nearest joint above it that the skin has, or to the other joints of the vertex. A vertex
  // without weights is moved by the first joint of its skin.
  void replace_weights(std::span<const GltfPrimitive> primitives, const Rig& rig);

  // Adds the humanoid map and meta data of a VRM 1.0 avatar, in place of what was there. joints: of rig(), or those of a skin by their names.
  // roles: per joint the name of VRM's human bone, or empty. meta: a JSON object with "name" and "authors"; "licenseUrl" is filled in.
  // https://github.com/vrm-c/vrm-specification, VRMC_vrm-1.0. Throws invalid_argument (a .gltf, a human bone that VRM requires is missing,
  // meta without a name or authors), invalid_file (meta is no JSON object).
  void add_vrm(const std::vector<Joint>& joints, std::span<const std::string> roles, std::string_view meta);

  // Adds
  //  - a scene root "focal_landmarks" with one child a landmark: its name, its translation, extras.focal;
  //  - mesh.extras.focal = {version, landmarks: [{name, status, confidence, primitive, triangle, barycentric}]} with the primitive's
  //    own triangle numbers and corner order.
  // Landmarks of an earlier call are replaced. Everything else stays: buffers byte for byte, numbers, extras, nulls.
  // Throws invalid_landmark (not finite, no such triangle).
  void add_landmarks(std::span<const GltfPrimitive> primitives, std::span<const GltfLandmark> landmarks);

  // The file, of the kind it came as, with what was added.
  std::vector<std::byte> bytes() const;

  // Names of the files beside it that it refers to, as they are in its folder.
  std::vector<std::filesystem::path> files_beside() const;
  const std::optional<std::filesystem::path>& folder() const;
  bool reads_files_beside() const;

 private:
  struct Opened;
  struct Edited;
  Edited& edited();

  std::shared_ptr<const Opened> opened_;
  std::unique_ptr<Edited> edited_;
};

// Moves what of document.mesh() has a skin to where the animation has it, `time` seconds after its start. Throws invalid_argument: the file
// has no such animation, or no skin.
void pose(const GltfDocument& document, const std::string& animation, double time, GltfMesh& gltf);

// A GLB from scratch: one mesh with smooth normals, and colours when given (vertices x 3, linear, 0..1, clamped) as COLOR_0.
// Throws invalid_mesh (no triangles, a position that is not finite in float), invalid_argument (colour rows).
std::vector<std::byte> write_glb(const TriangleMesh& mesh, const RowMatrixf& colours = {},
                                 const std::string& name = "mesh");

}  // namespace focal
