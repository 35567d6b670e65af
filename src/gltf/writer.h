// glTF out: a small GLB from scratch, and the caller's own file with landmarks added.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "gltf/reader.h"
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

}  // namespace focal
