#include "skeleton/rig_edits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "skeleton/bone_roles.h"

namespace focal {
namespace {

template <class T>
void keep(const std::vector<size_t>& kept, std::vector<T>& all) {
  if (all.empty()) return;
  std::vector<T> left;
  for (const size_t j : kept) left.push_back(std::move(all[j]));
  all = std::move(left);
}

void move_to(const std::vector<int32_t>& heir, Rig& rig) {
  const size_t most = rig.more.empty() ? max_influences : 2 * max_influences;
  for (size_t v = 0; v < rig.influences.size(); ++v) {
    std::vector<Influence> all = influences_of(rig, v);
    if (all.empty()) continue;
    for (Influence& one : all) one.joint = heir[one.joint];
    put_influences(heaviest(all, most), v, rig);
  }
}

class Arms {
 public:
  Arms(const std::vector<Joint>& joints, std::vector<Matrix4>& pose)
      : joints_(joints), roles_(bone_roles(joints)), pose_(pose) {}

  // Both upper arms are there.
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

  // Turns a joint, and all below it, so that another one lies that way from it.
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

void shift(std::vector<VertexInfluences>& all) {
  for (VertexInfluences& vertex : all)
    for (Influence& one : vertex)
      if (one.weight > 0) ++one.joint;
}

}  // namespace

bool is_helper_bone(const std::string& name) {
  const std::vector<std::string> words = bone_words(name);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word == "twist" || word == "roll" || word == "helper" || word == "corrective" || word == "share";
  });
}

std::vector<size_t> drop_helper_bones(CharacterRig& character) {
  auto& joints = character.rig.joints;
  std::vector<size_t> kept;
  std::vector<int32_t> heir(joints.size());  // among those that are left
  for (size_t j = 0; j < joints.size(); ++j) {
    const int32_t above = joints[j].parent < 0 ? -1 : heir[joints[j].parent];
    const bool goes = above >= 0 && is_helper_bone(joints[j].name);
    heir[j] = goes ? above : static_cast<int32_t>(kept.size());
    joints[j].parent = above;
    if (!goes) kept.push_back(j);
  }
  if (kept.size() == joints.size()) return kept;
  move_to(heir, character.rig);
  keep(kept, joints), keep(kept, character.tip), keep(kept, character.rest), keep(kept, character.confidence);
  keep(kept, character.left_out);
  return kept;
}

std::vector<Matrix4> stretched_arms(const std::vector<Joint>& joints, std::vector<Matrix4> rest,
                                    double below) {
  Arms arms(joints, rest);
  if (!arms.found()) return {};
  arms.stretch(below);
  return rest;
}

void add_ground_root(const std::string& name, const TriangleMesh& mesh, CharacterRig& character) {
  auto& joints = character.rig.joints;
  Joint root{name};
  const Vector3 above = joints.front().bind.topRightCorner<3, 1>();
  root.bind.topRightCorner<3, 1>() = Vector3(above[0], mesh.positions.col(1).minCoeff(), above[2]);
  for (Joint& joint : joints) ++joint.parent;  // roots hang on it now
  joints.insert(joints.begin(), root);
  character.tip.insert(character.tip.begin(), above);
  character.confidence.insert(character.confidence.begin(), 1);
  if (!character.left_out.empty()) character.left_out.insert(character.left_out.begin(), 0);
  if (!character.rest.empty()) character.rest.insert(character.rest.begin(), root.bind);
  shift(character.rig.influences), shift(character.rig.more);
}

}  // namespace focal
