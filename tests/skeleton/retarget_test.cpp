// What a retargeted animation keeps: keys, where joints point to in the world, and moves of its own size.
#include "skeleton/retarget.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <numbers>

using namespace focal;

namespace {

Matrix4 frame(const Matrix3& turn, const Vector3& place) {
  Matrix4 result = Matrix4::Identity();
  result.topLeftCorner<3, 3>() = turn;
  result.topRightCorner<3, 1>() = place;
  return result;
}

Matrix3 about_z(double angle) { return Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix(); }

// A file of nodes: each with its parent and its place in it.
struct File {
  NodeTree tree;
  Clip clip{"clip", {}};
  int32_t add(int32_t parent, const Matrix4& local) {
    const auto node = static_cast<int32_t>(tree.parent.size());
    tree.parent.push_back(parent);
    tree.order.push_back(node);
    tree.depth.push_back(parent < 0 ? 0 : tree.depth[parent] + 1);
    NodePose pose;
    pose.translation = local.topRightCorner<3, 1>();
    pose.rotation = Eigen::Quaterniond(Matrix3(local.topLeftCorner<3, 3>()));
    tree.pose.push_back(pose);
    tree.local.push_back(local);
    return node;
  }
  Keys& turn(int32_t node, const std::vector<double>& times, const std::vector<double>& angles,
             Interpolation interpolation = Interpolation::linear) {
    Keys keys{times, RowMatrix(static_cast<Eigen::Index>(angles.size()), 4), interpolation};
    for (size_t k = 0; k < angles.size(); ++k)
      keys.values.row(static_cast<Eigen::Index>(k)) =
          Eigen::Quaterniond(about_z(angles[k])).coeffs().transpose();
    clip.channels.push_back({node, NodeProperty::rotation, keys});
    return clip.channels.back().keys;
  }
  void move(int32_t node, const std::vector<double>& times, const std::vector<Vector3>& places) {
    Keys keys{times, RowMatrix(static_cast<Eigen::Index>(places.size()), 3), Interpolation::linear};
    for (size_t k = 0; k < places.size(); ++k)
      keys.values.row(static_cast<Eigen::Index>(k)) = places[k].transpose();
    clip.channels.push_back({node, NodeProperty::translation, keys});
  }
  std::vector<Joint> joints(const std::vector<std::pair<std::string, int32_t>>& named) const {
    const auto world = world_transforms(tree);
    std::vector<Joint> result;
    for (const auto& [name, node] : named) {
      int32_t parent = -1;
      for (size_t j = 0; j < result.size(); ++j)
        for (int32_t above = tree.parent[node]; above >= 0; above = tree.parent[above])
          if (result[j].node == above) parent = std::max(parent, static_cast<int32_t>(j));
      result.push_back({name, parent, world[node], node});
    }
    return result;
  }
};

// A hip and a knee, twice as long as the target, which stands bent.
File legs() {
  File file;
  const int32_t hip = file.add(-1, frame(Matrix3::Identity(), {0, 4, 0}));
  file.add(hip, frame(Matrix3::Identity(), {0, -2, 0}));
  return file;
}

const std::vector<Joint> target = {{"hip", -1, frame(about_z(0.5), {0, 2, 0})},
                                   {"knee", 0, frame(about_z(0.5), {0.4, 1, 0})},
                                   {"hat", 0, frame(Matrix3::Identity(), {0, 3, 0})}};

// Where the target's joints are at a time.
std::vector<Matrix4> posed(const std::vector<Joint>& joints, const std::vector<JointKeys>& keys,
                           double time) {
  std::vector<Matrix4> world;
  for (size_t j = 0; j < joints.size(); ++j) {
    Matrix4 local = joints[j].bind;
    if (joints[j].parent >= 0) local = joints[joints[j].parent].bind.inverse() * local;
    if (!keys[j].rotation.empty()) {
      const Vector q = keys[j].rotation.at(time);
      local.topLeftCorner<3, 3>() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
    }
    if (!keys[j].translation.empty()) local.topRightCorner<3, 1>() = keys[j].translation.at(time);
    world.push_back(joints[j].parent < 0 ? local : Matrix4(world[joints[j].parent] * local));
  }
  return world;
}

void check_same_turns(const File& file, const std::vector<Joint>& source, const std::vector<JointKeys>& keys,
                      double time) {
  const auto theirs = world_transforms(file.tree, &file.clip, time);
  const auto ours = posed(target, keys, time);
  for (size_t j = 0; j < source.size(); ++j)
    CHECK((ours[j].topLeftCorner<3, 3>() - theirs[source[j].node].topLeftCorner<3, 3>()).norm() < 1e-9);
}

}  // namespace

TEST_CASE("joints turn in the world as the source's do, at its keys and between them") {
  File file = legs();
  file.turn(0, {0, 1, 3}, {0, 0.7, 2});
  file.turn(1, {0, 2}, {0.1, -0.4}, Interpolation::step);
  const auto source = file.joints({{"hip", 0}, {"knee", 1}});
  const auto found = retarget({source, file.tree}, file.clip, target, {}, 0.5);
  REQUIRE(found.joints.size() == 3);
  CHECK(found.missing == std::vector<std::string>{"hat"});
  CHECK(found.joints[0].rotation.times == std::vector<double>{0, 1, 3});
  CHECK(found.joints[1].rotation.times == std::vector<double>{0, 2});
  CHECK(found.joints[1].rotation.interpolation == Interpolation::step);
  for (const double time : {0.0, 0.4, 1.0, 1.9, 2.0, 3.0}) check_same_turns(file, source, found.joints, time);
}

TEST_CASE("cubic keys stay cubic, with their tangents") {
  File file = legs();
  Keys& keys = file.turn(1, {0, 1, 2}, {0, 0, 0, 0, 0.5, 0, 0, 2, 0}, Interpolation::cubic);
  for (const int tangent : {0, 2, 3, 5, 6, 8}) keys.values.row(tangent) << 0, 0, 0.3, -0.1;
  const auto source = file.joints({{"hip", 0}, {"knee", 1}});
  const auto found = retarget({source, file.tree}, file.clip, target, {}, 0.5);
  CHECK(found.joints[1].rotation.interpolation == Interpolation::cubic);
  CHECK(found.joints[1].rotation.times == std::vector<double>{0, 1, 2});
  for (const double time : {0.0, 0.25, 0.5, 1.0, 1.7, 2.0})
    check_same_turns(file, source, found.joints, time);
}

TEST_CASE("a joint that stands below a node that moves is sampled, and lies where the source's does") {
  File file;
  const int32_t lift = file.add(-1, frame(Matrix3::Identity(), {0, 0, 0}));  // no joint
  const int32_t hip = file.add(lift, frame(about_z(0.2), {0, 4, 0}));
  const int32_t between = file.add(hip, frame(about_z(-0.3), {0, -1, 0}));  // no joint either
  const int32_t knee = file.add(between, frame(Matrix3::Identity(), {0, -1, 0}));
  file.turn(lift, {0, 2}, {0, 1});
  file.turn(between, {0, 1}, {-0.3, 0.5});
  file.turn(knee, {0, 2}, {0, -1});
  const auto source = file.joints({{"hip", hip}, {"knee", knee}});
  const auto found = retarget({source, file.tree}, file.clip, target, {}, 0.5);
  CHECK(found.joints[1].rotation.times == std::vector<double>{0, 1, 2});
  for (const double time : {0.0, 1.0, 2.0}) check_same_turns(file, source, found.joints, time);
}

TEST_CASE("a hip that moves is moved by as much of the target's size; what only turns keeps its length") {
  File file = legs();
  file.turn(0, {0, 2}, {0, 2});
  file.move(0, {0, 0.7, 2}, {{0, 4, 0}, {0.7, 4, 0}, {2, 4, 0}});
  const auto source = file.joints({{"hip", 0}, {"knee", 1}});
  const auto found = retarget({source, file.tree}, file.clip, target, {}, 0.5).joints;
  REQUIRE(found[0].translation.times.size() == 3);
  CHECK((found[0].translation.values.row(0).transpose() - Vector3(0, 2, 0)).norm() < 1e-9);
  CHECK((found[0].translation.values.row(1).transpose() - Vector3(0.35, 2, 0)).norm() < 1e-9);
  CHECK(found[1].translation.empty());
}

TEST_CASE("a joint that the source lacks stays as it is, and joints below it follow all the same") {
  File file = legs();
  file.turn(1, {0, 1}, {0, 1});
  const auto source = file.joints({{"hip", 0}, {"knee", 1}});
  std::vector<Joint> longer = target;  // hip, shin (unknown), knee
  longer[1].name = "shin", longer[2] = {"knee", 1, frame(about_z(0.1), {0.5, 0, 0})};
  const auto found = retarget({source, file.tree}, file.clip, longer, {}, 0.5);
  CHECK(found.missing == std::vector<std::string>{"shin"});
  CHECK(found.joints[1].rotation.empty());
  CHECK(found.joints[1].translation.empty());
  const auto ours = posed(longer, found.joints, 1);
  CHECK((ours[2].topLeftCorner<3, 3>() - about_z(1)).norm() < 1e-9);
  CHECK(retarget({source, file.tree}, {"none", {}}, longer, {}, 1).joints[0].rotation.empty());
}

TEST_CASE("of two skeletons with the same names the one counts that the clip moves") {
  File file = legs();
  const int32_t hip = file.add(-1, frame(Matrix3::Identity(), {9, 4, 0}));
  const int32_t knee = file.add(hip, frame(Matrix3::Identity(), {0, -2, 0}));
  file.turn(knee, {0, 1}, {0, 1});
  const auto source = file.joints({{"hip", 0}, {"knee", 1}, {"hip (2)", hip}, {"knee (2)", knee}});
  const auto found = retarget({source, file.tree}, file.clip, target, {}, 0.5);
  CHECK(found.joints[1].rotation.times.size() == 2);
  CHECK(found.joints[0].translation.empty());  // it stands beside the first, and has not moved
}

TEST_CASE("joints of another convention turn by their own axes") {
  File file;
  const int32_t hips = file.add(-1, frame(Matrix3::Identity(), {0, 1, 0}));
  const int32_t arm = file.add(hips, frame(Matrix3::Identity(), {1, 0, 0}));
  file.turn(arm, {0, 1}, {0, 0.8});
  const auto source = file.joints({{"mixamorig:Hips", hips}, {"mixamorig:LeftArm", arm}});
  const Matrix3 axes = Eigen::AngleAxisd(1.2, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  const std::vector<Joint> ours = {{"pelvis", -1, frame(axes, {0, 1, 0})},
                                   {"upperarm_l", 0, frame(axes.transpose(), {1, 1, 0})}};
  const std::vector<Matrix4> rest = {ours[0].bind, ours[1].bind};
  const auto found = retarget({source, file.tree}, file.clip, ours, rest, 1);
  CHECK(found.missing.empty());
  const auto after = posed(ours, found.joints, 1);
  CHECK((after[1].topLeftCorner<3, 3>() - about_z(0.8) * axes.transpose()).norm() < 1e-9);
}
