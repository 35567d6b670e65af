#include "skeleton/taught_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/landmark_model.h"
#include "skeleton/leak_filter.h"
#include "spectrum/functional_map.h"

namespace focal {
namespace {
// Chosen on left-out characters of game packs.
// Weight of a length in space relative to lengths in the embedding, both in sqrt(area).
constexpr double space_share = 400;
constexpr double rigid_teachers = 0.92;  // hardness from which weights are not smoothed
constexpr float max_exponent = 2, max_exponent_rigid = 8;
constexpr int between = PlacesBetween::vertices;
constexpr double min_length = 1e-4;  // shorter bones have no direction

// Mean end of a joint's bones; the joint itself without bones.
Vector3 end_of(const std::vector<SkeletonJoint>& joints, const std::vector<Vector3>& place,
               const std::vector<Vector3>& tip, size_t joint, int32_t& count) {
  Vector3 sum = Vector3::Zero();
  count = 0;
  for (size_t j = joint + 1; j < joints.size(); ++j)
    if (joints[j].parent == static_cast<int32_t>(joint)) sum += place[j], ++count;
  return count > 0 ? Vector3(sum / count) : tip[joint];
}

struct OldJoints {
  std::vector<Vector3> place;
  std::vector<char> is_there;
};

OldJoints joints_of(const std::vector<SkeletonJoint>& joints, const ShapeRig& rig) {
  OldJoints result;
  for (size_t j = 0; j < joints.size(); ++j) {
    const int32_t p = joints[j].parent;
    result.is_there.push_back(rig.bind[j].has_value());
    result.place.push_back(rig.bind[j] ? Vector3(rig.bind[j]->topRightCorner<3, 1>())
                           : p >= 0    ? result.place[p]
                                       : Vector3::Zero());
  }
  return result;
}

// Transforms a training shape's joints to the detected ones, with its bones rotated and scaled to theirs.
std::vector<Matrix4> transforms_onto(const PlacedSkeleton& skeleton, const ShapeRig& rig) {
  const auto& joints = skeleton.joints;
  const OldJoints old = joints_of(joints, rig);
  std::vector<Matrix4> result(joints.size(), Matrix4::Identity());
  std::vector<double> size(joints.size(), 1);
  for (size_t j = 0; j < joints.size(); ++j) {
    const int32_t p = joints[j].parent;
    if (p >= 0) size[j] = size[p], result[j] = result[p];
    if (!old.is_there[j]) continue;
    int32_t bones = 0;
    const Vector3 from = end_of(joints, old.place, rig.tip, j, bones) - old.place[j];
    const Vector3 to = end_of(joints, skeleton.place, skeleton.tip, j, bones) - skeleton.place[j];
    Matrix3 turn = skeleton.turn[j] * rig.bind[j]->topLeftCorner<3, 3>().transpose();
    if (from.norm() > min_length && to.norm() > min_length) {
      if (bones < 2) turn = Eigen::Quaterniond::FromTwoVectors(turn * from, to).toRotationMatrix() * turn;
      size[j] = std::clamp(to.norm() / from.norm(), 0.5, 2.0);
    }
    result[j].topLeftCorner<3, 3>() = size[j] * turn;
    result[j].topRightCorner<3, 1>() = skeleton.place[j] - size[j] * turn * old.place[j];
  }
  return result;
}

// Eigenfunctions, followed by positions in space.
RowMatrixf with_places(const RowMatrixf& spectral, const MatrixX3& places) {
  RowMatrixf result(spectral.rows(), spectral.cols() + 3);
  result.leftCols(spectral.cols()) = spectral;
  result.rightCols(3) = (space_share * places).cast<float>();
  return result;
}

void add_weights(const Exemplar& shape, const ShapeMap& one, const SurfaceAnalysis& analysis,
                 const MatrixX3& posed, float weight, RowMatrixf& sum) {
  const Eigen::MatrixXf& C = one.map.C;
  const Eigen::Index points = shape.positions.rows();
  const PlacesBetween near = nearest_between(
      with_places(analysis.eigenfunctions.leftCols(C.cols()) * C.transpose(), analysis.surface().positions),
      with_places(shape.samples.Phi.topLeftCorner(points, C.rows()), posed));
  for (Eigen::Index v = 0; v < sum.rows(); ++v)
    for (int k = 0; k < between; ++k)
      for (const Influence& influence : shape.rig->influences[near.vertex[v * between + k]])
        sum(v, influence.joint) += weight * near.weight[v * between + k] * influence.weight;
}

// Mean of the sum of squared weights: 1 where every vertex follows one joint.
double hardness_of(const Teachers& teachers) {
  double sum = 0, total = 0;
  for (size_t m = 0; m < teachers.maps.size(); ++m) {
    const Exemplar& shape = teachers.model.exemplars[teachers.maps[m].shape];
    for (Eigen::Index i = 0; i < shape.positions.rows(); ++i) {
      const double area = teachers.weight[m] * shape.samples.weight[i];
      double squares = 0;
      for (const Influence& one : shape.rig->influences[i]) squares += one.weight * one.weight;
      if (squares > 0) sum += area * squares, total += area;
    }
  }
  return total > 0 ? sum / total : 0;
}

double hardness_of(const RowMatrixf& weights, const Vector& mass, float exponent) {
  double sum = 0;
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    Eigen::RowVectorXf row = weights.row(v);
    sharpen(row, exponent);
    sum += mass[v] * row.squaredNorm();
  }
  return sum / mass.sum();
}

// The exponent of the weights that makes them as hard as the training shapes' are.
float exponent_for(const RowMatrixf& weights, const Vector& mass, double hardness) {
  float low = 1, high = hardness < rigid_teachers ? max_exponent : max_exponent_rigid;
  for (int round = 0; round < 8; ++round) {
    const float middle = (low + high) / 2;
    (hardness_of(weights, mass, middle) < hardness ? low : high) = middle;
  }
  return low;
}

// Averages weights of neighbours, so that no single vertex separates from its neighbourhood.
void smooth(RowMatrixf& weights, const SparseMatrix& L) {
  RowMatrixf next = weights;
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    float count = 1;
    for (SparseMatrix::InnerIterator it(L, v); it; ++it)
      if (it.row() != v) next.row(v) += weights.row(it.row()), ++count;
    next.row(v) /= count;
  }
  weights = std::move(next);
}

}  // namespace

void sharpen(Eigen::Ref<Eigen::RowVectorXf> weights, float exponent) {
  const float most = weights.maxCoeff();
  if (!(most > 0)) return;
  weights = (weights / most).array().pow(exponent).matrix();
  weights /= weights.sum();
}

RowMatrixf bone_distances(const PlacedSkeleton& skeleton, const MatrixX3& places) {
  const auto joints = static_cast<Eigen::Index>(skeleton.joints.size());
  RowMatrixf result = RowMatrixf::Constant(places.rows(), joints, std::numeric_limits<float>::infinity());
  std::vector<char> has_child(skeleton.joints.size(), 0);
  const auto add_bone = [&](Eigen::Index joint, const Vector3& from, const Vector3& to) {
    const Vector3 way = to - from;
    const double squared = std::max(way.squaredNorm(), 1e-20);
    for (Eigen::Index v = 0; v < places.rows(); ++v) {
      const Vector3 off = places.row(v).transpose() - from;
      const double along = std::clamp(off.dot(way) / squared, 0.0, 1.0);
      result(v, joint) = std::min(result(v, joint), static_cast<float>((off - along * way).norm()));
    }
  };
  for (size_t j = 0; j < skeleton.joints.size(); ++j)
    if (const int32_t p = skeleton.joints[j].parent; p >= 0)
      has_child[p] = 1, add_bone(p, skeleton.place[p], skeleton.place[j]);
  for (Eigen::Index j = 0; j < joints; ++j)
    if (!has_child[j]) add_bone(j, skeleton.place[j], skeleton.tip[j]);
  return result;
}

SurfaceWeights taught_weights(const Teachers& teachers, const SurfaceAnalysis& analysis,
                              const PlacedSkeleton& skeleton, const Execution& execution) {
  const auto joints = static_cast<Eigen::Index>(skeleton.joints.size());
  RowMatrixf sum = RowMatrixf::Zero(analysis.surface().vertex_count(), joints);
  std::vector<RowMatrixf> of_shape(teachers.maps.size(), RowMatrixf::Zero(sum.rows(), joints));
  std::vector<MatrixX3> posed(teachers.maps.size());
  parallel_for(execution, static_cast<int64_t>(teachers.maps.size()), [&](int64_t m) {
    const Exemplar& shape = teachers.model.exemplars[teachers.maps[m].shape];
    posed[m] = skinned(shape.positions, shape.rig->influences, transforms_onto(skeleton, *shape.rig));
    add_weights(shape, teachers.maps[m], analysis, posed[m], static_cast<float>(teachers.weight[m]),
                of_shape[m]);
  });
  for (const RowMatrixf& one : of_shape) sum += one;
  SurfaceWeights result{std::move(sum)};
  for (Eigen::Index v = 0; v < result.weights.rows(); ++v) {
    const float total = result.weights.row(v).sum();
    if (total > 0) result.weights.row(v) /= total;
  }
  drop_leaks(result.weights, analysis, skeleton, habits_of(teachers, skeleton, posed));
  const double hardness = hardness_of(teachers);
  if (hardness < rigid_teachers) smooth(result.weights, analysis.operators.L);
  result.exponent = exponent_for(result.weights, analysis.operators.mass, hardness);
  return result;
}

}  // namespace focal
