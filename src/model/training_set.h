// Marked shapes: what training starts from.
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
  std::vector<std::optional<Matrix4>>
      bind;                  // a joint of the set's skeleton: rigid, or none where it is missing here
  std::vector<Vector3> tip;  // the far end of its region, in the same coordinates
  std::vector<VertexInfluences> influences;  // a vertex of mesh->surface
};

struct MarkedShape {
  std::shared_ptr<const PreparedMesh> mesh;
  std::vector<std::optional<SurfacePoint>>
      marks;  // on mesh->surface; one a landmark name; empty: absent here
  std::optional<ShapeRig> rig = std::nullopt;
  bool is_copy = false;  // of another shape of the set, in another pose or of other proportions
};

// Of the skeleton that all rigged shapes of a set share.
struct SkeletonJoint {
  std::string name;
  int32_t parent = -1;  // comes before it; -1: a root
};

inline constexpr size_t longest_template = 1 << 20;

struct TrainingSet {
  std::vector<std::string> landmark_names;
  std::vector<MarkedShape> shapes;
  std::vector<SkeletonJoint> skeleton;  // empty: no shape has a rig
  std::string skeleton_template = {};   // over the landmarks, as JSON; empty: none. The model keeps it
};

}  // namespace focal
