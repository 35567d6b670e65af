#include "skeleton/twist.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace focal {
namespace {

// Radians, of a bone relative to its parent's; chosen on left-out training characters.
constexpr double usual_twist = 0.1;
constexpr double min_error = 0.05;  // radians, of any measured rotation

}  // namespace

double twist_about(const Matrix3& rotation, const Vector3& axis) {
  const Eigen::Quaterniond q(rotation);
  const double angle = 2 * std::atan2(q.vec().dot(axis), q.w());
  return std::remainder(angle, 2 * std::numbers::pi);
}

// Least squares in the corrections c: c_j^2 / variance_j for all joints, and for each pair (twist_j + c_j - s
// c_p)^2 / usual_twist^2, where s is the share of the parent's correction that also rotates about the bone of
// j.
std::vector<double> twist_corrections(const std::vector<TwistedJoint>& joints) {
  const auto n = static_cast<Eigen::Index>(joints.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  Vector b = Vector::Zero(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const TwistedJoint& joint = joints[j];
    A(j, j) += 1 / (joint.variance + min_error * min_error);
    if (joint.parent < 0 || joint.bone.isZero()) continue;
    const Eigen::Index p = joint.parent;
    const TwistedJoint& parent = joints[p];
    const Matrix3 from_rest = parent.turn.transpose() * joint.turn * joint.rest.transpose() * parent.rest;
    const double twist = twist_about(from_rest, parent.turn.transpose() * joint.bone);
    const double shared = joint.bone.dot(parent.bone), strength = 1 / (usual_twist * usual_twist);
    A(j, j) += strength, A(p, p) += strength * shared * shared;
    A(j, p) -= strength * shared, A(p, j) -= strength * shared;
    b[j] -= strength * twist, b[p] += strength * shared * twist;
  }
  const Vector c = A.ldlt().solve(b);
  return {c.data(), c.data() + n};
}

}  // namespace focal
