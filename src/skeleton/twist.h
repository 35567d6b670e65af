// Rotation of joints about their own bones, which the surface of a thin round limb hardly determines.
#pragma once
#include <cstdint>
#include <vector>

#include "base/matrix.h"

namespace focal {

struct TwistedJoint {
  int32_t parent = -1;
  Matrix3 turn;         // its axes as measured
  Matrix3 rest;         // its axes in the rest pose of a training character
  Vector3 bone;         // unit direction of its bone; zero: none
  double variance = 0;  // of the measured rotation about the bone, radians squared
};

// The part of a rotation that is about a unit axis, in radians, -pi..pi.
double twist_about(const Matrix3& rotation, const Vector3& axis);

// For each joint the angle to rotate it about its bone, in radians: measurements are weighted by their
// variance, and twists between neighbouring bones are small, as in real bodies.
std::vector<double> twist_corrections(const std::vector<TwistedJoint>& joints);

}  // namespace focal
