// glTF out: a small GLB from scratch, and the caller's own file with landmarks added.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "gltf/reader.h"
#include "mesh/rig.h"
#include "mesh/triangle_mesh.h"

namespace focal {

// One mesh with smooth normals, and colours when given (vertices x 3, linear, 0..1, clamped) as COLOR_0.
// Throws invalid_mesh (no triangles, a position that is not finite in float), invalid_argument (colour rows).
std::vector<std::byte> write_glb(const TriangleMesh& mesh, const RowMatrixf& colours = {},
                                 const std::string& name = "mesh");

struct GltfLandmark {
  std::string name;
  SurfacePoint point;                  // on the merged mesh of read_gltf; triangle -1: none
  Vector3 position = Vector3::Zero();  // world coordinates
  double confidence = 1;               // 0..1
  std::string status = "found";        // found, uncertain, absent; an absent one gets no node
};

// The source file (.glb or .gltf, the same kind comes back) plus
//  - a scene root "focal_landmarks" with one child a landmark: its name, its translation, extras.focal;
//  - mesh.extras.focal = {version, landmarks: [{name, status, confidence, primitive, triangle, barycentric}]}
//  with
//    the primitive's own triangle numbers and corner order.
// Landmarks of an earlier call are replaced. Everything else stays: buffers byte for byte, numbers, extras,
// nulls. `primitives` are those read_gltf returned for the same file. Throws what parse_gltf throws, and
// invalid_landmark (not finite, no such triangle).
std::vector<std::byte> add_landmarks(std::span<const std::byte> source,
                                     std::span<const GltfPrimitive> primitives,
                                     std::span<const GltfLandmark> landmarks, const GltfLimits& limits = {});

struct GltfRig {
  const Rig* rig =
      nullptr;  // on the merged mesh of read_gltf: bind matrices rigid, one entry of influences a vertex
  std::vector<Vector3>
      tips;  // per joint where its part ends, world coordinates; a leaf joint gets a node there. Or none
  std::vector<Matrix4> pose =
      {};  // where the joints stand in the file; none: as bound, so that the mesh looks as it is
  std::vector<JointAnimation> animations =
      {};                              // added to those of the file; names that are taken get a number
  const TriangleMesh* mesh = nullptr;  // the merged mesh of read_gltf; needed where a primitive is mirrored
};

// The source file (the same kind comes back) with a skeleton and skin weights for every mesh that it shows: a scene root
// "focal_skeleton" with the joints below it, their places and rotations those of the bind matrices. Meshes that had a skin get
// this one; a node that may not carry a skin (it has a place or a parent, or is animated) hands its mesh to a new scene root of its name, and
// where it mirrors, the triangles of the file are turned: those of `primitives` are mirrored no longer. What an earlier call put in
// is replaced. Primitives that are marked as scenery stay as they are; a mesh must be scenery as a whole. A vertex without weights is
// moved by the first joint.
// Everything else stays. Data goes into the BIN chunk, or into a data: URI in a .gltf. Throws what parse_gltf throws, and
// invalid_argument (a rig of another mesh, more than 65,536 joints, not finite).
std::vector<std::byte> add_skin(std::span<const std::byte> source, std::span<const GltfPrimitive> primitives,
                                const GltfRig& rig, const GltfLimits& limits = {});

// The source file (the same kind comes back) with other weights for the meshes that have a skin; nodes, skins and bind matrices stay.
// rig: of read_gltf_rig for the same file, with other influences. A vertex without weights is moved by the first joint of its skin.
// Throws what parse_gltf throws.
std::vector<std::byte> replace_weights(std::span<const std::byte> source,
                                       std::span<const GltfPrimitive> primitives, const Rig& rig,
                                       const GltfLimits& limits = {});

}  // namespace focal
