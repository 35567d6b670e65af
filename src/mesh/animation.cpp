#include "mesh/animation.h"

#include <algorithm>
#include <map>

namespace focal {
namespace {

Vector slerp(const Vector& a, const Vector& b, double t) {
  const Eigen::Quaterniond from(a[3], a[0], a[1], a[2]), to(b[3], b[0], b[1], b[2]);
  return from.normalized().slerp(t, to.normalized()).coeffs();
}

}  // namespace

Vector Keys::at(double time) const {
  const bool cubic = interpolation == Interpolation::cubic, turns = values.cols() == 4;
  const auto row = [&](size_t key, size_t part) -> Vector {
    return values.row(static_cast<Eigen::Index>(cubic ? 3 * key + part : key)).transpose();
  };
  const auto unit = [&](const Vector& value) -> Vector {
    return turns && value.norm() > 0 ? Vector(value.normalized()) : value;
  };
  const auto next = static_cast<size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  if (next == 0) return unit(row(0, 1));
  if (next == times.size() || interpolation == Interpolation::step) return unit(row(next - 1, 1));
  const double span = times[next] - times[next - 1], t = (time - times[next - 1]) / span;
  const Vector a = row(next - 1, 1), b = row(next, 1);
  if (!cubic) return turns ? slerp(a, b, t) : Vector((1 - t) * a + t * b);
  const double t2 = t * t, t3 = t2 * t;
  return unit((2 * t3 - 3 * t2 + 1) * a + span * (t3 - 2 * t2 + t) * row(next - 1, 2) +
              (3 * t2 - 2 * t3) * b + span * (t3 - t2) * row(next, 0));
}

Matrix4 matrix_of(const NodePose& pose) {
  Eigen::Quaterniond rotation = pose.rotation.normalized();
  if (!rotation.coeffs().allFinite()) rotation = Eigen::Quaterniond::Identity();
  Matrix4 transform = Matrix4::Identity();
  transform.topLeftCorner<3, 3>() = rotation.toRotationMatrix() * pose.scale.asDiagonal();
  transform.topRightCorner<3, 1>() = pose.translation;
  return transform;
}

std::vector<Matrix4> world_transforms(const NodeTree& tree, const Clip* clip, double time) {
  std::vector<Matrix4> world = tree.local;
  std::map<int32_t, NodePose> posed;
  if (clip)
    for (const Channel& channel : clip->channels) {
      NodePose& pose = posed.try_emplace(channel.node, tree.pose[channel.node]).first->second;
      const Vector value = channel.keys.at(time);
      if (channel.property == NodeProperty::translation) pose.translation = value;
      if (channel.property == NodeProperty::scale) pose.scale = value;
      if (channel.property == NodeProperty::rotation)
        pose.rotation = Eigen::Quaterniond(value[3], value[0], value[1], value[2]);
    }
  for (const auto& [node, pose] : posed) world[node] = matrix_of(pose);
  for (const int32_t node : tree.order)
    if (tree.parent[node] >= 0) world[node] = world[tree.parent[node]] * world[node];
  return world;
}

}  // namespace focal
