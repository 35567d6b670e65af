// Turns about bones: what is measured well stays, what is not follows its neighbours.
#include "skeleton/twist.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "base/random.h"

using namespace focal;

namespace {

Matrix3 about(const Vector3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

// A straight chain along z; each joint is turned about it by an angle, at rest by none.
std::vector<TwistedJoint> turned_chain(const std::vector<double>& angles,
                                       const std::vector<double>& variances) {
  std::vector<TwistedJoint> joints;
  for (size_t j = 0; j < angles.size(); ++j)
    joints.push_back({static_cast<int32_t>(j) - 1, about(Vector3::UnitZ(), angles[j]), Matrix3::Identity(),
                      Vector3::UnitZ(), variances[j]});
  return joints;
}

}  // namespace

TEST_CASE("the twist of a rotation is what turns about the axis, whatever swings besides") {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Vector3 axis = Vector3(random.normal(), random.normal(), random.normal()).normalized();
    const double twist = 3 * (2 * random.uniform() - 1), swing = 1.5 * (2 * random.uniform() - 1);
    CHECK(twist_about(about(axis, twist) * about(axis.unitOrthogonal(), swing), axis) ==
          doctest::Approx(twist));
  }
  CHECK(std::abs(twist_about(about(Vector3::UnitX(), std::numbers::pi), Vector3::UnitX())) ==
        doctest::Approx(std::numbers::pi));
}

TEST_CASE(
    "a joint that nothing tells how it is turned lies between its neighbours; those that are known stay") {
  const auto by = twist_corrections(turned_chain({0.2, 2, 0.4}, {0, 100, 0}));
  CHECK(std::abs(by[0]) < 0.1);
  CHECK(std::abs(by[2]) < 0.1);
  CHECK(2 + by[1] == doctest::Approx((0.2 + by[0] + 0.4 + by[2]) / 2).epsilon(1e-3));
}

TEST_CASE("what agrees with the rest pose is left alone, however it is bent") {
  auto joints = turned_chain({0, 0, 0}, {1, 1, 1});
  const Matrix3 bend = about(Vector3::UnitX(), 1.2);
  joints[1].turn = bend, joints[1].bone = bend.col(2);
  joints[2].turn = bend, joints[2].bone = bend.col(2);
  for (const double angle : twist_corrections(joints)) CHECK(std::abs(angle) < 1e-9);
}

TEST_CASE("a joint without a bone is left alone") {
  auto joints = turned_chain({0, 1}, {0, 1});
  joints[1].bone.setZero();
  CHECK(twist_corrections(joints)[1] == 0);
  CHECK(twist_corrections({}).empty());
}
