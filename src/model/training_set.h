// Marked shapes: the input of training.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesh/prepare.h"
#include "mesh/rig.h"

namespace focal {

// The skeleton of one shape, in the coordinates of its surface.
struct ShapeRig {
  // Per joint of the set's skeleton: a rigid transform, or none where this shape lacks the joint.
  std::vector<std::optional<Matrix4>> bind;
  std::vector<Vector3> tip;                  // the far end of its region, in the same coordinates
  std::vector<VertexInfluences> influences;  // per vertex of mesh->surface
};

struct MarkedShape {
  std::shared_ptr<const PreparedMesh> mesh;
  // On mesh->surface, one per landmark name; empty: absent on this shape.
  std::vector<std::optional<SurfacePoint>> marks;
  std::optional<ShapeRig> rig = std::nullopt;
  bool is_copy = false;  // a copy of another shape of the set, in another pose or other proportions
};

// A joint of the skeleton that all rigged shapes of a set share.
struct SkeletonJoint {
  std::string name;
  int32_t parent = -1;  // comes before it; -1: a root
};

inline constexpr size_t longest_template = 1 << 20;

struct TrainingSet {
  std::vector<std::string> landmark_names;
  std::vector<MarkedShape> shapes;
  std::vector<SkeletonJoint> skeleton;  // empty: the shapes have no rigs
  std::string skeleton_template = {};   // over the landmarks, as JSON; empty: none. Stored in the model
};

}  // namespace focal
