// Bones, their limits, and bending a mesh with them.
#pragma once
#include <string>
#include <vector>

#include "geometry.h"
#include "random.h"

namespace creatures {

struct Joint {
  std::string name;
  int parent;  // -1 for the root; parents come before their children
  Vec3 rest, tip;
};

// One way a joint can turn: about `axis`, between two angles in degrees. `paired`: the other side's joint can
// turn likewise, mirrored, by an angle of its own.
struct Freedom {
  int joint;
  Vec3 axis;
  double low, high;
  bool paired = false;
};

struct Skeleton {
  std::vector<Joint> joints;
  std::vector<int> mirror;  // the joint of the other side, or the joint itself

  int add(const std::string& name, int parent, const Vec3& rest, const Vec3& tip);
  // "left..." and "right...", at the given place and its mirror image; returns the left one. A parent that has
  // a mirror itself is mirrored too.
  int add_pair(const std::string& name, int parent, const Vec3& rest, const Vec3& tip);
};

using Pose = std::vector<Eigen::Isometry3d>;  // from rest to posed, a joint

// The root also turns by `heading` about the up axis.
Pose random_pose(const Skeleton& skeleton, const std::vector<Freedom>& freedoms, double heading,
                 Random& random);

constexpr int max_influences = 4;
struct Influences {
  std::array<int, max_influences> joints{};
  std::array<double, max_influences> weights{};
};

// From weights of each bone at each vertex: averaged over neighbours `rounds` times, then the strongest few.
std::vector<Influences> skin_of(std::vector<std::vector<double>> weights,
                                const std::vector<Triangle>& triangles, int rounds);

Vec3 bend(const Vec3& rest, const Influences& influences, const Pose& pose);

}  // namespace creatures
