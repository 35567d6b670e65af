// How joints are turned about their own bones, which the surface of a thin round limb hardly tells.
#pragma once
#include <cstdint>
#include <vector>

#include "base/matrix.h"

namespace focal {

struct TwistedJoint {
  int32_t parent = -1;
  Matrix3 turn;         // its axes as measured
  Matrix3 rest;         // its axes in the rest pose of a training character
  Vector3 bone;         // the way its bone points, length 1; zero: none
  double variance = 0;  // of the measured turn about the bone, radians squared
};

// The part of a rotation that is about an axis of length 1, in radians, -pi..pi.
double twist_about(const Matrix3& rotation, const Vector3& axis);

// Per joint the angle about its bone to turn it by, in radians: measurements count by their variance, and bones are twisted little
// against each other, as joints of bodies are.
std::vector<double> twist_corrections(const std::vector<TwistedJoint>& joints);

}  // namespace focal
