// A rig of a body that stands alike on both sides, made exactly so.
#pragma once
#include "mesh/triangle_mesh.h"
#include "skeleton/character_rig.h"
#include "skeleton/fixed_joints.h"

namespace focal {

// {x: normal . x = offset}
struct MirrorPlane {
  Vector3 normal = Vector3::UnitX();  // of length 1
  double offset = 0;

  Vector3 operator()(const Vector3& p) const { return p - 2 * (normal.dot(p) - offset) * normal; }
  Matrix3 turn() const { return Matrix3::Identity() - 2 * normal * normal.transpose(); }
};

// Per vertex the one of the smallest number at its place's mirror image, -1: none.
struct MirroredVertices {
  MirrorPlane plane;
  std::vector<int32_t> partner;
  double share = 0;  // of the vertices that have one
};

// By the plane that mirrors most vertices onto others, looked for from the one given.
MirroredVertices mirrored_vertices(const MatrixX3& positions, const MirrorPlane& near);

// Joints of both sides, whose names identify them, and weights of vertices that are mirror images of each other become mirror images
// too; joints without a side come into the plane. Of a pair the side that is known better counts more; a fixed joint stays, and the
// other one is its mirror image. Fewer than half of the vertices have partners: the body does not stand alike on both sides, bones get
// the same lengths (make_bones_symmetric), and a warning says so.
void make_symmetric(const TriangleMesh& mesh, const FixedJoints& fixed, CharacterRig& character);

// The rest pose (character.rest) of a symmetric rig, about the plane between its own sides.
void make_rest_symmetric(CharacterRig& character);

}  // namespace focal
