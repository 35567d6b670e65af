// What a retargeted animation keeps: where joints point to in the world, and moves of its own size.
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

// A hip and a knee of a source twice as long as the target, which stands bent.
const std::vector<Joint> source = {{"hip", -1, frame(Matrix3::Identity(), {0, 4, 0})},
                                   {"knee", 0, frame(Matrix3::Identity(), {0, 2, 0})}};
const std::vector<Joint> target = {{"hip", -1, frame(about_z(0.5), {0, 2, 0})},
                                   {"knee", 0, frame(about_z(0.5), {0.4, 1, 0})},
                                   {"hat", 0, frame(Matrix3::Identity(), {0, 3, 0})}};

JointTracks bend() {
  JointTracks tracks;
  for (const double angle : {0.0, 0.7, 2.0}) {
    tracks["hip"].push_back(frame(about_z(angle), {angle, 4, 0}));
    tracks["knee"].push_back(
        frame(about_z(2 * angle), Vector3(angle, 4, 0) + about_z(angle) * Vector3(0, -2, 0)));
  }
  return tracks;
}

}  // namespace

TEST_CASE("joints turn in the world as the source's do") {
  const JointTracks tracks = bend();
  const auto keys = retarget(source, tracks, target, 0.5);
  REQUIRE(keys.size() == 3);
  for (size_t t = 0; t < 3; ++t) {
    const Matrix3 hip = keys[0].rotation[t].toRotationMatrix(),
                  knee = hip * keys[1].rotation[t].toRotationMatrix();
    CHECK((hip - tracks.at("hip")[t].topLeftCorner<3, 3>()).norm() < 1e-9);
    CHECK((knee - tracks.at("knee")[t].topLeftCorner<3, 3>()).norm() < 1e-9);
    if (t > 0) CHECK(keys[0].rotation[t].dot(keys[0].rotation[t - 1]) >= 0);
  }
}

TEST_CASE("a hip that moves is moved by as much of the target's size; what only turns keeps its length") {
  const auto keys = retarget(source, bend(), target, 0.5);
  REQUIRE(keys[0].translation.size() == 3);
  CHECK((keys[0].translation[0] - Vector3(0, 2, 0)).norm() < 1e-9);
  CHECK((keys[0].translation[1] - Vector3(0.35, 2, 0)).norm() < 1e-9);
  CHECK(keys[1].translation.empty());
}

TEST_CASE("a joint that the source lacks stays as it is") {
  const auto keys = retarget(source, bend(), target, 0.5);
  CHECK(keys[2].rotation.empty());
  CHECK(keys[2].translation.empty());
  CHECK(retarget(source, {}, target, 1)[0].rotation.empty());
}
