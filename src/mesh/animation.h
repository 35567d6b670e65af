// Animations as files keep them: keys of nodes, and where the nodes stand in between (glTF 2.0, sections 3.11 and appendix C).
#pragma once
#include <string>
#include <vector>

#include "base/matrix.h"

namespace focal {

enum class Interpolation { linear, step, cubic };

// Keys of one property. A row of values a time; cubic: three rows (in-tangent, value, out-tangent).
struct Keys {
  std::vector<double> times;  // seconds, ascending
  RowMatrix values;           // rotations: x, y, z, w
  Interpolation interpolation = Interpolation::linear;

  bool empty() const { return times.empty(); }
  // Before the first key and past the last the value stays. Rotations take the shorter arc, and are of length 1.
  Vector at(double time) const;
};

// Where a node stands to its parent.
struct NodePose {
  Vector3 translation = Vector3::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Vector3 scale = Vector3::Ones();
};
Matrix4 matrix_of(const NodePose& pose);

// All nodes of a file. Parents may come after their children: `order` has them first.
struct NodeTree {
  std::vector<int32_t> parent;  // -1: a root
  std::vector<int32_t> order;
  std::vector<int32_t> depth;  // 0: a root
  std::vector<NodePose>
      pose;  // a node that is given by a matrix counts as standing at its parent once it is animated
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

// Of each node to the world, at a moment of the clip; without one as the file has them.
std::vector<Matrix4> world_transforms(const NodeTree& tree, const Clip* clip = nullptr, double time = 0);

// How a joint stands to its parent over time; without keys it stays as it is.
struct JointKeys {
  Keys rotation, translation;
};

struct JointAnimation {
  std::string name;
  std::vector<JointKeys> joints;  // one a joint
};

}  // namespace focal
