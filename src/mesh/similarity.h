// Rotations and similarities fitted to points (S. Umeyama, "Least-Squares Estimation of Transformation Parameters Between Two
// Point Patterns", 1991).
#pragma once
#include "base/matrix.h"

namespace focal {

// The rotation nearest to a matrix; identity for one that is not finite or of rank below 2.
Matrix3 nearest_rotation(const Matrix3& matrix);

struct Similarity {
  double scale = 1;
  Matrix3 rotation = Matrix3::Identity();
  Vector3 offset = Vector3::Zero();
  double residual = 0;  // root mean square of the remaining distances, in units of `to`

  Vector3 operator()(const Vector3& p) const { return scale * (rotation * p) + offset; }
};

// The similarity that best maps the rows of `from` to those of `to`, weighted (>= 0, not all 0).
Similarity fit_similarity(const MatrixX3& from, const MatrixX3& to, const Vector& weight);

}  // namespace focal
