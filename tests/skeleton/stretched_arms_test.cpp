// T and A poses: the angle of the arms, and what hangs on them.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "skeleton/rig_edits.h"

using namespace focal;

namespace {

// A humanoid whose arms hang, one of them bent, that looks along a direction of its own.
std::vector<Joint> hanging(double heading) {
  const struct {
    const char* name;
    int32_t parent;
    Vector3 place;
  } bones[] = {{"hips", -1, {0, 1, 0}},
               {"spine", 0, {0, 1.2, 0}},
               {"head", 1, {0, 1.6, 0}},
               {"leftUpperArm", 1, {0.2, 1.4, 0}},
               {"leftLowerArm", 3, {0.25, 1.1, 0.02}},
               {"leftHand", 4, {0.3, 0.9, 0.2}},
               {"leftMiddleProximal", 5, {0.3, 0.85, 0.28}},
               {"rightUpperArm", 1, {-0.2, 1.4, 0}},
               {"rightLowerArm", 7, {-0.22, 1.1, 0}},
               {"rightHand", 8, {-0.24, 0.8, 0}},
               {"leftUpperLeg", 0, {0.1, 0.9, 0}},
               {"rightUpperLeg", 0, {-0.1, 0.9, 0}}};
  const Matrix3 turn = Eigen::AngleAxisd(heading, Vector3::UnitY()).toRotationMatrix();
  std::vector<Joint> joints;
  for (const auto& bone : bones) {
    joints.push_back({bone.name, bone.parent});
    joints.back().bind.topRightCorner<3, 1>() = turn * bone.place;
  }
  return joints;
}

std::vector<Matrix4> rest_of(const std::vector<Joint>& joints) {
  std::vector<Matrix4> rest;
  for (const Joint& joint : joints) rest.push_back(joint.bind);
  return rest;
}

Vector3 bone(const std::vector<Matrix4>& pose, size_t from, size_t to) {
  return (pose[to] - pose[from]).topRightCorner<3, 1>();
}

}  // namespace

TEST_CASE("arms are level in a T pose and 45 degrees below in an A pose, whichever way the body looks") {
  for (const double heading : {0.0, 0.7, -2.0})
    for (const double below : {0.0, std::numbers::pi / 4}) {
      const std::vector<Joint> joints = hanging(heading);
      const std::vector<Matrix4> rest = rest_of(joints), pose = stretched_arms(joints, rest, below);
      REQUIRE(pose.size() == joints.size());
      const Vector3 left = Eigen::AngleAxisd(heading, Vector3::UnitY()) * Vector3::UnitX();
      const std::pair<size_t, size_t> bones[] = {{3, 4}, {4, 5}, {5, 6}, {7, 8}, {8, 9}};
      for (const auto& [from, to] : bones) {
        const Vector3 way = bone(pose, from, to).normalized();
        CHECK(std::asin(-way[1]) == doctest::Approx(below).epsilon(1e-9));
        CHECK(way.dot(left) == doctest::Approx((from < 7 ? 1 : -1) * std::cos(below)).epsilon(1e-9));
        CHECK(bone(pose, from, to).norm() == doctest::Approx(bone(rest, from, to).norm()));
      }
      for (const size_t still : {0, 1, 2, 3, 7, 10, 11})
        CHECK((pose[still] - rest[still]).topRightCorner<3, 1>().norm() < 1e-12);
      for (const Matrix4& one : pose) CHECK(one.topLeftCorner<3, 3>().determinant() == doctest::Approx(1));
    }
}

TEST_CASE("what has no two arms has no T pose") {
  std::vector<Joint> joints = hanging(0);
  for (Joint& joint : joints)
    if (joint.name.starts_with("right")) joint.name = "tail";
  CHECK(stretched_arms(joints, rest_of(joints), 0).empty());
}
