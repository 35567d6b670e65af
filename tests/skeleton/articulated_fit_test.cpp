// A training character bent and stretched onto another body: onto itself it stays as it is, a known pose and stretch are found again, and
// facing the other way it lies farther off.
#include "skeleton/articulated_fit.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "skeleton/character_rig.h"
#include "skeleton/small_rig.h"

using namespace focal;
using namespace focal_test;

namespace {

struct Subject {
  std::shared_ptr<const LandmarkModel> model = rig_model();
  std::vector<int32_t> counterpart;
  TriangleMesh surface;  // of the first training shape

  Subject() {
    std::vector<Joint> joints;
    for (const SkeletonJoint& joint : model->skeleton) joints.push_back({joint.name, joint.parent});
    counterpart = other_sides(joints);
    surface = training_set_of({rigged(humanoid(1))}, {.shapes = 8, .landmarks = 40}).shapes[0].mesh->surface;
  }
  const Exemplar& shape() const { return model->exemplars[0]; }
};

const Subject& subject() {
  static const Subject one;
  return one;
}

Posture at_rest(const ArticulatedFit& fit) {
  const size_t joints = subject().model->skeleton.size();
  Posture result{
      std::vector<Vector3>(joints, Vector3::Zero()), std::vector<Matrix3>(joints, Matrix3::Identity()),
      Vector::Zero(static_cast<Eigen::Index>(joints)), Vector::Zero(static_cast<Eigen::Index>(joints))};
  for (size_t j = 0; j < joints; ++j)
    if (fit.has(j)) result.place[j] = fit.bind_place(j);
  return result;
}

size_t joint_named(const std::string& name) {
  const auto& skeleton = subject().model->skeleton;
  const auto at =
      std::find_if(skeleton.begin(), skeleton.end(), [&](const auto& one) { return one.name == name; });
  REQUIRE(at != skeleton.end());
  return static_cast<size_t>(at - skeleton.begin());
}

// The first training shape's surface, its rig's joints moved so.
MatrixX3 moved(const std::vector<Matrix4>& by) {
  const TrainingSet set = training_set_of({rigged(humanoid(1))}, {.shapes = 8, .landmarks = 40});
  return skinned(set.shapes[0].mesh->surface.positions, set.shapes[0].rig->influences, by);
}

Matrix4 about(const Vector3& place, const Matrix3& turn) {
  Matrix4 result = Matrix4::Identity();
  result.topLeftCorner<3, 3>() = turn;
  result.topRightCorner<3, 1>() = place - turn * place;
  return result;
}

double farthest(const ArticulatedFit& fit, const Posture& found, const std::vector<Matrix4>& by) {
  double most = 0;
  for (size_t j = 0; j < by.size(); ++j)
    if (fit.has(j))
      most = std::max(most, (found.place[j] - (by[j] * fit.bind_place(j).homogeneous()).head<3>()).norm());
  return most;
}

}  // namespace

TEST_CASE("onto its own surface a training shape stays as it is") {
  const FitTarget target(subject().surface);
  const ArticulatedFit fit(subject().model->skeleton, subject().shape(), subject().counterpart, target);
  Posture posture = at_rest(fit);
  const Posture before = posture;
  CHECK(fit.residual(posture) < 0.03);
  fit.run({.coarse = 4, .fine = 3}, {}, posture);
  CHECK(fit.residual(posture) <
        1.1 * fit.residual(before));  // of distances, of which the fit minimises a robust part
  for (size_t j = 0; j < posture.place.size(); ++j)
    if (fit.has(j)) CHECK((posture.place[j] - before.place[j]).norm() < 0.02);
}

TEST_CASE("a bent arm and knee, and a larger body, are found again") {
  const auto& skeleton = subject().model->skeleton;
  const FitTarget at_bind(subject().surface);
  const ArticulatedFit rest(skeleton, subject().shape(), subject().counterpart, at_bind);
  std::vector<Matrix4> by(skeleton.size(), Matrix4::Identity());
  const size_t arm = joint_named("leftLowerArm"), knee = joint_named("rightLowerLeg");
  for (size_t j = 0; j < skeleton.size(); ++j) {
    if (skeleton[j].parent >= 0) by[j] = by[skeleton[j].parent];
    const Vector3 axis = j == arm ? Vector3::UnitY() : Vector3::UnitX();
    if (j == arm || j == knee)
      by[j] = by[j] * about(rest.bind_place(j), Eigen::AngleAxisd(0.6, axis).toRotationMatrix());
  }
  for (Matrix4& one : by) one.topRows<3>() *= 1.1;
  const FitTarget target({moved(by), subject().surface.triangles});
  const ArticulatedFit fit(skeleton, subject().shape(), subject().counterpart, target);
  Posture posture = at_rest(fit);
  const double before = fit.residual(posture);
  fit.run({.coarse = 15, .fine = 10}, {}, posture);
  CHECK(fit.residual(posture) < 0.6 * before);
  CHECK(farthest(fit, posture, by) < 0.05);  // of sqrt(area): at first the hand lies 0.3 off
  CHECK(farthest(fit, at_rest(fit), by) > 0.15);
}

TEST_CASE("a control on the ground that moves no vertex comes along, and pulls nothing") {
  const Vector3 ground(0, subject().surface.positions.col(1).minCoeff(), 0);
  Exemplar shape = subject().shape();
  std::vector<SkeletonJoint> skeleton = subject().model->skeleton;
  for (SkeletonJoint& joint : skeleton) ++joint.parent;
  skeleton.insert(skeleton.begin(), {"root", -1});
  for (VertexInfluences& vertex : shape.rig->influences)
    for (Influence& one : vertex) one.joint += one.weight > 0;
  Matrix4 bind = Matrix4::Identity();
  bind.topRightCorner<3, 1>() = ground;
  shape.rig->bind.insert(shape.rig->bind.begin(), bind),
      shape.rig->tip.insert(shape.rig->tip.begin(), ground);
  std::vector<int32_t> counterpart{-1};
  for (const int32_t one : subject().counterpart) counterpart.push_back(one < 0 ? -1 : one + 1);

  const FitTarget target({1.1 * subject().surface.positions, subject().surface.triangles});
  const ArticulatedFit without(subject().model->skeleton, subject().shape(), subject().counterpart, target);
  Posture expected = at_rest(without), posture = expected;
  without.run({}, {}, expected);
  const ArticulatedFit fit(skeleton, shape, counterpart, target);
  posture.place.insert(posture.place.begin(), Vector3::Zero());
  posture.turn.insert(posture.turn.begin(), Matrix3::Identity());
  posture.length = posture.girth = Vector::Zero(static_cast<Eigen::Index>(skeleton.size()));
  fit.run({}, {}, posture);
  CHECK((posture.place[0] - 1.1 * ground).norm() < 0.03);
  for (size_t j = 1; j < skeleton.size(); ++j)
    if (fit.has(j)) CHECK((posture.place[j] - expected.place[j - 1]).norm() < 1e-9);
}

TEST_CASE("facing the other way it lies farther off") {
  const FitTarget target(subject().surface);
  const ArticulatedFit fit(subject().model->skeleton, subject().shape(), subject().counterpart, target);
  Posture forwards = at_rest(fit), backwards = forwards;
  const Matrix3 half_turn = Vector3(-1, 1, -1).asDiagonal();
  for (size_t j = 0; j < backwards.place.size(); ++j)
    backwards.place[j] = half_turn * forwards.place[j], backwards.turn[j] = half_turn;
  for (Posture* one : {&forwards, &backwards}) fit.run({}, {}, *one);
  CHECK(fit.residual(backwards) > 1.2 * fit.residual(forwards));
}
