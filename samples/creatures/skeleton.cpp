// Bones, their limits, and bending a mesh with them.
// L. Kavan, S. Collins, J. Zara, C. O'Sullivan, "Geometric Skinning with Approximate Dual Quaternion Blending",
// 2008; halfway to linear blending, because the first swells at bent joints and the second shrinks.
#include "skeleton.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace creatures {

int Skeleton::add(const std::string& name, int parent, const Vec3& rest, const Vec3& tip) {
  joints.push_back({name, parent, rest, tip});
  mirror.push_back(static_cast<int>(joints.size()) - 1);
  return mirror.back();
}

int Skeleton::add_pair(const std::string& name, int parent, const Vec3& rest, const Vec3& tip) {
  const int left = add("left" + name, parent, rest, tip);
  const int right = add("right" + name, parent < 0 ? parent : mirror[parent], mirrored(rest), mirrored(tip));
  mirror[left] = right;
  mirror[right] = left;
  return left;
}

Pose random_pose(const Skeleton& skeleton, const std::vector<Freedom>& freedoms, double heading,
                 Random& random) {
  std::vector<Eigen::Quaterniond> local(skeleton.joints.size(), Eigen::Quaterniond::Identity());
  const auto turn = [&](int joint, const Vec3& axis, const Freedom& limit) {
    const double angle = random.typical(limit.low, limit.high) * std::numbers::pi / 180;
    local[joint] = Eigen::AngleAxisd(angle, axis.normalized()) * local[joint];
  };
  for (const Freedom& freedom : freedoms) {
    turn(freedom.joint, freedom.axis, freedom);
    // A mirror turns rotation axes the other way round than it turns points.
    if (freedom.paired) turn(skeleton.mirror[freedom.joint], -mirrored(freedom.axis), freedom);
  }
  Pose pose(skeleton.joints.size(), Eigen::Isometry3d::Identity());
  for (size_t i = 0; i < pose.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    if (joint.parent >= 0)
      pose[i] = pose[joint.parent];
    else
      pose[i].linear() = Eigen::AngleAxisd(heading, Vec3::UnitY()).toRotationMatrix();
    pose[i] = pose[i] * Eigen::Translation3d(joint.rest) * local[i] * Eigen::Translation3d(-joint.rest);
  }
  return pose;
}

std::vector<Influences> skin_of(std::vector<std::vector<double>> weights,
                                const std::vector<Triangle>& triangles, int rounds) {
  const size_t count = weights.size(), bones = count ? weights.front().size() : 0;
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::vector<double>> sums(count, std::vector<double>(bones, 0.0));
    for (const Triangle& t : triangles)
      for (int corner : t)
        for (int other : t)
          for (size_t b = 0; b < bones; ++b) sums[corner][b] += weights[other][b];
    for (auto& w : sums) {
      double total = 0;
      for (double x : w) total += x;
      for (double& x : w) x /= total;
    }
    weights = std::move(sums);
  }
  std::vector<Influences> result(count);
  for (size_t v = 0; v < count; ++v) {
    std::vector<double>& w = weights[v];
    double total = 0;
    for (int k = 0; k < max_influences; ++k) {
      const auto best = std::max_element(w.begin(), w.end());
      if (*best < 1e-4) break;
      result[v].joints[k] = static_cast<int>(best - w.begin());
      result[v].weights[k] = *best;
      total += *best;
      *best = 0;
    }
    for (double& x : result[v].weights) x /= total;
  }
  return result;
}

Vec3 bend(const Vec3& rest, const Influences& influences, const Pose& pose) {
  Vec3 linear = Vec3::Zero();
  Eigen::Vector4d real = Eigen::Vector4d::Zero(), dual = Eigen::Vector4d::Zero(), pivot = real;
  for (int k = 0; k < max_influences; ++k) {
    const double weight = influences.weights[k];
    if (weight == 0) continue;
    const Eigen::Isometry3d& motion = pose[influences.joints[k]];
    linear += weight * (motion * rest);
    const Eigen::Quaterniond q(motion.rotation());
    const Vec3 t = motion.translation();
    const Eigen::Quaterniond d = Eigen::Quaterniond(0, 0.5 * t.x(), 0.5 * t.y(), 0.5 * t.z()) * q;
    if (k == 0) pivot = q.coeffs();
    const double sign = pivot.dot(q.coeffs()) < 0 ? -weight : weight;
    real += sign * q.coeffs();
    dual += sign * d.coeffs();
  }
  const double length = real.norm();
  const Eigen::Quaterniond q(Eigen::Vector4d(real / length)), d(Eigen::Vector4d(dual / length));
  return 0.5 * (linear + q * rest + 2 * (d * q.conjugate()).vec());
}

}  // namespace creatures
