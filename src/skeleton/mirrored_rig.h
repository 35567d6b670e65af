// Makes the rig of a symmetric body exactly symmetric.
#pragma once
#include "mesh/triangle_mesh.h"
#include "skeleton/character_rig.h"
#include "skeleton/fixed_joints.h"

namespace focal {

// The plane {x: normal . x = offset}.
struct MirrorPlane {
  Vector3 normal = Vector3::UnitX();  // unit length
  double offset = 0;

  Vector3 operator()(const Vector3& p) const { return p - 2 * (normal.dot(p) - offset) * normal; }
  Matrix3 turn() const { return Matrix3::Identity() - 2 * normal * normal.transpose(); }
};

// For each vertex the smallest number of a vertex at its mirror image, -1: none.
struct MirroredVertices {
  MirrorPlane plane;
  std::vector<int32_t> partner;
  double share = 0;  // of the vertices with a counterpart
};

// Uses the plane that maps most vertices to others, searched from the given one.
MirroredVertices mirrored_vertices(const MatrixX3& positions, const MirrorPlane& near);

// Left and right joints, recognised by their names, become mirror images, as do weights of vertices that are
// mirror images; joints without a side are moved into the plane. Of a pair the side of higher confidence
// counts more; a fixed joint is unchanged, and its counterpart becomes its mirror image. If fewer than half
// of the vertices have counterparts, the body is not symmetric: bones get equal lengths
// (make_bones_symmetric), with a warning.
void make_symmetric(const TriangleMesh& mesh, const FixedJoints& fixed, CharacterRig& character);

// Makes the rest pose (character.rest) of a symmetric rig symmetric, about the plane between its own sides.
void make_rest_symmetric(CharacterRig& character);

}  // namespace focal
