// One glTF file: opened and checked once, then read and written through this class.
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
  // Positions that are not finite are kept, an index out of range becomes -1, for prepare to skip; empty
  // parts are skipped.
  bool lenient = false;
  // Also read meshes that KHR_node_visibility hides.
  bool hidden_too = false;
};

// The range of the merged mesh that a primitive of the file became.
struct GltfPrimitive {
  int32_t mesh = -1, primitive = -1;  // indices in the file
  int32_t node = -1;                  // the node of the scene that shows it; -1: none
  int32_t first_vertex = 0, vertex_count = 0;
  int32_t first_triangle = 0, triangle_count = 0;
  Matrix4 world_transform = Matrix4::Identity();  // merged position = world_transform * position in the file
  // The node's transform is a reflection: corners 1 and 2 of each triangle were swapped, so that triangles
  // stay counter-clockwise from outside.
  bool mirrored = false;
  bool is_scenery = false;  // set by callers: add_skin does not change its mesh and node
  int32_t skin = -1;        // that moves it
  int32_t joint = -1;       // without a skin: the node of the joint that it is below
  bool is_posed = false;    // its joints place each vertex individually; world_transform is not used
};

struct GltfMesh {
  TriangleMesh mesh;                      // primitives consecutively, nodes depth first in scene order
  std::vector<GltfPrimitive> primitives;  // in the same order
  std::vector<MeshPiece> pieces;          // the triangles of each instance of a mesh, in the same order
  std::vector<std::string> hidden;        // nodes whose meshes were skipped: KHR_node_visibility hides them
  std::vector<std::string> warnings;      // sentences on what was skipped or assumed
};

struct GltfAnimations {
  NodeTree tree;
  std::vector<Clip> clips;            // those that animate a node
  std::vector<std::string> warnings;  // on skipped channels
};

struct GltfLandmark {
  std::string name;
  SurfacePoint point;                             // on the merged mesh; triangle -1: none
  Vector3 position = Vector3::Zero();             // world coordinates
  double confidence = 1;                          // 0..1
  LandmarkStatus status = LandmarkStatus::found;  // an absent one gets no node
};

// A joint of the file that a new one replaces, and its bind transform.
struct ReplacedJoint {
  int32_t node = -1;
  Matrix4 bind = Matrix4::Identity();
};

struct GltfRig {
  const Rig* rig = nullptr;  // on the merged mesh: rigid bind matrices, one entry of influences per vertex
  // Per joint the far end of its part, world coordinates; a leaf joint gets a node there. Or empty.
  std::vector<Vector3> tips;
  // Pose of the joints in the file; empty: the bind pose, so that the mesh looks unchanged.
  std::vector<Matrix4> pose = {};
  // Added to those of the file; names in use get a number.
  std::vector<JointAnimation> animations = {};
  const TriangleMesh* mesh = nullptr;  // the merged mesh; needed where a primitive is mirrored
  // Per joint. Children of and references to the replaced joint move to the new one. Or empty.
  std::vector<ReplacedJoint> replaces = {};
};

// Keeps the file unchanged together with a typed view of it. Copies share both. Reading is thread-safe.
class GltfDocument {
 public:
  // folder: of the files beside it, which `allow_external_files` permits to read. Throws invalid_file
  // (truncated or malformed), unsupported (required extension, a limit).
  explicit GltfDocument(std::vector<std::byte> bytes, const GltfReadParams& params = {},
                        std::optional<std::filesystem::path> folder = std::nullopt);
  // Also throws file_not_found, io.
  static GltfDocument open(const std::filesystem::path& path, const GltfReadParams& params = {});
  GltfDocument(const GltfDocument&);
  GltfDocument(GltfDocument&&) noexcept;
  GltfDocument& operator=(GltfDocument&&) noexcept;
  ~GltfDocument();

  bool is_binary() const;

  // Merges every triangle primitive of the shown scene into one mesh in world coordinates. Supported: modes
  // TRIANGLES, TRIANGLE_STRIP and TRIANGLE_FAN; float and 8/16-bit positions (KHR_mesh_quantization), sparse
  // accessors, EXT_meshopt_compression, indices of any width or none; morph targets with the file's default
  // weights. Images and materials are ignored.
  //
  // The scene is the file's default, else all scenes; if these show no mesh, all nodes, then all meshes. Each
  // instance of a mesh is included. A skinned mesh is in its bind pose, placed in the world by its topmost
  // joint (glTF ignores the node's own transform there); in the file's pose if the bind pose has all joints
  // in one position. A mesh below a joint is where the bind pose has that joint. Nodes that
  // KHR_node_visibility hides, and their children, are skipped, unless all are hidden.
  //
  // Throws invalid_file; unsupported (external buffer, a limit); invalid_mesh (no triangles, NaN or infinite
  // position, index out of range); file_not_found, io (a buffer beside the file).
  GltfMesh mesh() const;

  // Merges all skins of the primitives into one skeleton, with bind matrices in the merged mesh's coordinates
  // and unique joint names. A mesh below a joint is moved by that joint alone. Empty without a skin. Weights
  // that are negative, NaN or infinite count as 0; invalid_weights, if given, receives their number. Throws
  // what mesh() throws; invalid_file (a weight of a joint that does not exist, a singular bind matrix).
  std::optional<Rig> rig(std::span<const GltfPrimitive> primitives, int64_t* invalid_weights = nullptr) const;

  // Animations of nodes: translation, rotation, scale. Throws what mesh() throws.
  GltfAnimations animations() const;

  // Adds a skeleton and skin weights for every mesh of the primitives: a scene root "focal_skeleton" with the
  // joints below it, at the positions and rotations of the bind matrices. Meshes that had a skin get this
  // one. A node that cannot have a skin (it has a transform or a parent, or is animated) passes its mesh to a
  // new scene root of its name, and references to the mesh through the node are updated; each instance of a
  // mesh gets its own copy. Where a node is a reflection, the triangles of the file are reversed. The result
  // of an earlier call is replaced. Primitives marked as scenery are not changed; a mesh must be scenery as a
  // whole. A vertex without weights is moved by the first joint. `primitives` are those of mesh() and are
  // updated to the new nodes. Everything else is unchanged. Data goes into the BIN chunk, or into a data: URI
  // in a .gltf.
  // Throws invalid_argument (a rig of another mesh, more than 65,536 joints, not finite).
  void add_skin(std::span<GltfPrimitive> primitives, const GltfRig& rig);

  // Replaces the weights of the primitives that have a skin; nodes, skins and bind matrices are unchanged
  // (except where all bind matrices are at one position: there the primitive is written in the shown pose,
  // with a copy of its skin bound in that pose). rig: result of rig() with other influences. The weight of a
  // joint that a primitive's skin lacks goes to the nearest joint above it that the skin has, or to the other
  // joints of the vertex. A vertex without weights is moved by the first joint of its skin.
  void replace_weights(std::span<const GltfPrimitive> primitives, const Rig& rig);

  // Adds the humanoid bones and meta data of a VRM 1.0 avatar, replacing existing ones. joints: of rig(), or
  // those of a skin by their names. roles: per joint the name of VRM's human bone, or empty. meta: a JSON
  // object with "name" and "authors"; "licenseUrl" gets a default.
  // https://github.com/vrm-c/vrm-specification, VRMC_vrm-1.0. Throws invalid_argument (a .gltf, a required
  // human bone is missing, meta without a name or authors), invalid_file (meta is not a JSON object).
  void add_vrm(const std::vector<Joint>& joints, std::span<const std::string> roles, std::string_view meta);

  // Adds
  //  - a scene root "focal_landmarks" with one child per landmark: its name, its translation, extras.focal;
  //  - mesh.extras.focal = {version, landmarks: [{name, status, confidence, primitive, triangle,
  // barycentric}]} with the primitive's own triangle numbers and corner order.
  // Landmarks of an earlier call are replaced. Everything else is unchanged: buffers byte for byte, numbers,
  // extras, nulls. Throws invalid_landmark (not finite, no such triangle).
  void add_landmarks(std::span<const GltfPrimitive> primitives, std::span<const GltfLandmark> landmarks);

  // The file, of its original type, with the additions.
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

// Poses the skinned parts of document.mesh() as the animation has them `time` seconds after its start. Throws
// invalid_argument: the file has no such animation, or no skin.
void pose(const GltfDocument& document, const std::string& animation, double time, GltfMesh& gltf);

// Creates a GLB: one mesh with smooth normals, and colours if given (vertices x 3, linear, 0..1, clamped) as
// COLOR_0. Throws invalid_mesh (no triangles, a position that is not finite in float), invalid_argument
// (colour rows).
std::vector<std::byte> write_glb(const TriangleMesh& mesh, const RowMatrixf& colours = {},
                                 const std::string& name = "mesh");

}  // namespace focal
