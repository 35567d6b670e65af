#include "skeleton/stretched_arms.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "skeleton/bone_roles.h"

namespace focal {
namespace {

class Arms {
 public:
  Arms(const std::vector<Joint>& joints, std::vector<Matrix4>& pose)
      : joints_(joints), roles_(bone_roles(joints)), pose_(pose) {}

  // Whether both upper arms exist.
  bool found() const { return joint_of("leftUpperArm") >= 0 && joint_of("rightUpperArm") >= 0; }

  void stretch(double below) {
    Vector3 left = place(joint_of("leftUpperArm")) - place(joint_of("rightUpperArm"));
    left[1] = 0;
    left.normalize();
    const Vector3 down(0, -std::sin(below), 0);
    for (const bool is_left : {true, false})
      stretch_side(is_left ? "left" : "right", (is_left ? 1 : -1) * std::cos(below) * left + down);
  }

 private:
  int32_t joint_of(const std::string& role) const {
    const auto at = std::find(roles_.begin(), roles_.end(), role);
    return at == roles_.end() ? -1 : static_cast<int32_t>(at - roles_.begin());
  }
  Vector3 place(int32_t joint) const { return pose_[joint].topRightCorner<3, 1>(); }

  void stretch_side(const std::string& side, const Vector3& way) {
    const int32_t chain[] = {joint_of(side + "UpperArm"), joint_of(side + "LowerArm"),
                             joint_of(side + "Hand"), joint_of(side + "MiddleProximal")};
    for (int i = 0; i < 3; ++i)
      if (chain[i] >= 0 && chain[i + 1] >= 0) point(chain[i], chain[i + 1], way);
  }

  // Rotates a joint and its descendants so that another joint is in this direction from it.
  void point(int32_t joint, int32_t end, const Vector3& way) {
    const Vector3 bone = place(end) - place(joint), centre = place(joint);
    if (bone.isZero()) return;
    const Matrix3 turn = Eigen::Quaterniond::FromTwoVectors(bone, way).toRotationMatrix();
    Matrix4 moved = Matrix4::Identity();
    moved.topLeftCorner<3, 3>() = turn, moved.topRightCorner<3, 1>() = centre - turn * centre;
    std::vector<char> below(joints_.size(), 0);
    for (size_t j = 0; j < joints_.size(); ++j) {
      const int32_t p = joints_[j].parent;
      below[j] = static_cast<int32_t>(j) == joint || (p >= 0 && below[p]);
      if (below[j]) pose_[j] = moved * pose_[j];
    }
  }

  const std::vector<Joint>& joints_;
  const std::vector<std::string> roles_;
  std::vector<Matrix4>& pose_;
};

}  // namespace

std::vector<Matrix4> stretched_arms(const std::vector<Joint>& joints, std::vector<Matrix4> rest,
                                    double below) {
  Arms arms(joints, rest);
  if (!arms.found()) return {};
  arms.stretch(below);
  return rest;
}

}  // namespace focal
