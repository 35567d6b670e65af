// Fixed joints lie where they must; the others follow as an elastic line does.
#include "skeleton/fixed_joints.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace focal;

namespace {

// A straight chain along x, joints `step` apart.
struct Chain {
  std::vector<int32_t> parent;
  std::vector<Vector3> place, tip;
  std::vector<Matrix3> turn;

  Chain(int count, double step) {
    for (int j = 0; j < count; ++j) {
      parent.push_back(j - 1), place.emplace_back(step * j, 0, 0), tip.emplace_back(step * (j + 1), 0, 0);
      turn.push_back(Matrix3::Identity());
    }
  }
  void follow(const FixedJoints& fixed, double reach) {
    focal::follow(fixed, reach, MovableSkeleton{parent, place, tip, turn});
  }
};

}  // namespace

TEST_CASE("without fixed joints nothing moves") {
  Chain chain(4, 1);
  const Chain before = chain;
  chain.follow({}, 0.5);
  CHECK(chain.place == before.place);
  chain.follow(FixedJoints(4), 0.5);
  for (size_t j = 0; j < 4; ++j) CHECK((chain.place[j] - before.place[j]).norm() < 1e-12);
}

TEST_CASE("a fixed joint lies there to the bit, the others follow by cosh of the distance to the free ends") {
  // reach^2 d'' = d, d' = 0 at both ends: d(x) = d0 cosh((end - x) / reach) / cosh((end - x0) / reach).
  constexpr int count = 201, middle = 80;
  constexpr double step = 0.01, reach = 0.4, lift = 0.1;
  Chain chain(count, step);
  FixedJoints fixed(count);
  fixed[middle] = Vector3(0.1 + middle * step, lift, 0.3);
  chain.follow(fixed, reach);
  CHECK(chain.place[middle] == *fixed[middle]);
  for (const int j : {0, 40, 79, 81, 120, 200}) {
    const double end = j < middle ? 0 : (count - 1) * step;
    const double expected =
        lift * std::cosh((end - j * step) / reach) / std::cosh((end - middle * step) / reach);
    CHECK(chain.place[static_cast<size_t>(j)][1] == doctest::Approx(expected).epsilon(0.01));
    CHECK(chain.tip[static_cast<size_t>(j)][1] == doctest::Approx(chain.place[static_cast<size_t>(j)][1]));
  }
}

TEST_CASE("between two fixed joints others lie between, and turns go with the bones") {
  Chain chain(5, 1);
  FixedJoints fixed(5);
  fixed[0] = Vector3(0, 0, 0), fixed[4] = Vector3(0, 4, 0);
  chain.follow(fixed, 1000);  // so stiff that the displacement is linear
  for (size_t j = 0; j < 5; ++j) {
    const double share = static_cast<double>(j) / 4;
    CHECK((chain.place[j] - Vector3(static_cast<double>(j) - 4 * share, 4 * share, 0)).norm() < 1e-3);
    CHECK((chain.turn[j].transpose() * chain.turn[j] - Matrix3::Identity()).norm() < 1e-9);
  }
  for (size_t j = 0; j < 4; ++j)  // what pointed along x points along y
    CHECK((chain.turn[j] * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-3);
}

TEST_CASE("on a finished rig fixed joints are certain") {
  CharacterRig character;
  for (int j = 0; j < 3; ++j) {
    Joint joint{"j" + std::to_string(j), j - 1};
    joint.bind.topRightCorner<3, 1>() = Vector3(j, 0, 0);
    character.rig.joints.push_back(joint);
    character.tip.emplace_back(j + 1, 0, 0), character.confidence.push_back(0.25);
  }
  FixedJoints fixed(3);
  fixed[1] = Vector3(1, 0.5, 0);
  follow(fixed, 0.5, character);
  CHECK(Vector3(character.rig.joints[1].bind.topRightCorner<3, 1>()) == *fixed[1]);
  CHECK(character.confidence == std::vector<double>{0.25, 1, 0.25});
  const double above = character.rig.joints[0].bind(1, 3);
  CHECK(above > 0.01);
  CHECK(above < 0.49);
}
