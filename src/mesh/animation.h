// Animations as stored in files: keyframes of nodes and their interpolation (glTF 2.0, sections 3.11 and
// appendix C).
#pragma once
#include <string>
#include <vector>

#include "base/matrix.h"

namespace focal {

enum class Interpolation { linear, step, cubic };

// Keyframes of one property. One row of values per time; cubic: three rows (in-tangent, value, out-tangent).
struct Keys {
  std::vector<double> times;  // seconds, ascending
  RowMatrix values;           // rotations: x, y, z, w
  Interpolation interpolation = Interpolation::linear;

  bool empty() const { return times.empty(); }
  // Constant before the first key and after the last. Rotations take the shorter arc and are normalised.
  Vector at(double time) const;
};

// Transform of a node relative to its parent.
struct NodePose {
  Vector3 translation = Vector3::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Vector3 scale = Vector3::Ones();
};
Matrix4 matrix_of(const NodePose& pose);

// All nodes of a file. Parents may come after their children; `order` lists parents first.
struct NodeTree {
  std::vector<int32_t> parent;  // -1: a root
  std::vector<int32_t> order;
  std::vector<int32_t> depth;  // 0: a root
  // A node with a matrix gets the identity here once it is animated.
  std::vector<NodePose> pose;
  std::vector<Matrix4> local;  // without animation
};

enum class NodeProperty { translation, rotation, scale };

struct Channel {
  int32_t node = 0;
  NodeProperty property = NodeProperty::rotation;
  Keys keys;
};

struct Clip {
  std::string name;
  std::vector<Channel> channels;
};

// World transform of each node at a time of the clip; without a clip as in the file.
std::vector<Matrix4> world_transforms(const NodeTree& tree, const Clip* clip = nullptr, double time = 0);

// Keyframes of a joint relative to its parent; without keys it is constant.
struct JointKeys {
  Keys rotation, translation;
};

struct JointAnimation {
  std::string name;
  std::vector<JointKeys> joints;  // one per joint
};

}  // namespace focal
