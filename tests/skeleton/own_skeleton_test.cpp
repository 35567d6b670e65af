// Weights for a skeleton that is there: near those that it has, from the body alone.
#include "skeleton/own_skeleton.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "skeleton/small_rig.h"

using namespace focal;
using namespace focal_test;

namespace {

// Mean over the vertices of the sum of absolute differences, 0 to 2.
double difference(const Rig& a, const Rig& b) {
  double sum = 0;
  for (size_t v = 0; v < a.influences.size(); ++v) {
    std::vector<double> weight(a.joints.size(), 0);
    for (const Influence& one : a.influences[v]) weight[one.joint] += one.weight;
    for (const Influence& one : b.influences[v]) weight[one.joint] -= one.weight;
    for (const double w : weight) sum += std::abs(w);
  }
  return sum / static_cast<double>(a.influences.size());
}

}  // namespace

TEST_CASE("a humanoid's own joints get nearly its own weights, and stay to the bit") {
  const RiggedMesh character = rigged(humanoid(3));
  const CharacterRig found = weights_for(own_skeleton_of(character.rig), character.mesh, 4, execution);
  REQUIRE(found.rig.joints.size() == character.rig.joints.size());
  for (size_t j = 0; j < found.rig.joints.size(); ++j) {
    CHECK(found.rig.joints[j].bind == character.rig.joints[j].bind);
    CHECK(found.rig.joints[j].name == character.rig.joints[j].name);
  }
  CHECK(found.warnings.empty());
  CHECK(difference(found.rig, character.rig) < 0.3);
  for (const VertexInfluences& one : found.rig.influences) {
    float sum = 0;
    for (const Influence& influence : one) sum += influence.weight;
    CHECK(sum == doctest::Approx(1).epsilon(1e-5));
  }
}

TEST_CASE("joints that move nothing get no weights, wherever they lie") {
  RiggedMesh character = rigged(humanoid(3));
  const auto pole = static_cast<int32_t>(character.rig.joints.size());
  Joint joint{"pole", 0, character.rig.joints[0].bind};
  joint.bind.topRightCorner<3, 1>() = character.rig.joints.back().bind.topRightCorner<3, 1>();
  character.rig.joints.push_back(joint);
  const CharacterRig found = weights_for(own_skeleton_of(character.rig), character.mesh, 8, execution);
  for (const auto* set : {&found.rig.influences, &found.rig.more})
    for (const VertexInfluences& vertex : *set)
      for (const Influence& one : vertex) CHECK_FALSE((one.weight > 0 && one.joint == pole));
}

TEST_CASE("where no joint moves anything yet, all of them do") {
  RiggedMesh character = rigged(humanoid(3));
  for (VertexInfluences& one : character.rig.influences) one = {};
  const OwnSkeleton skeleton = own_skeleton_of(character.rig);
  CHECK(std::count(skeleton.moves.begin(), skeleton.moves.end(), 1) ==
        static_cast<std::ptrdiff_t>(character.rig.joints.size()));
}

TEST_CASE("joints outside the body are named; a skeleton that moves nothing is refused") {
  const RiggedMesh character = rigged(humanoid(3));
  OwnSkeleton skeleton = own_skeleton_of(character.rig);
  skeleton.joints[1].bind.topRightCorner<3, 1>() += Vector3(5, 0, 0);
  const CharacterRig found = weights_for(skeleton, character.mesh, 4, execution);
  REQUIRE(found.warnings.size() == 1);
  CHECK(found.warnings[0].find("1 joint lies outside the body ('" + skeleton.joints[1].name + "')") == 0);
  std::fill(skeleton.moves.begin(), skeleton.moves.end(), 0);
  CHECK_THROWS_AS(weights_for(skeleton, character.mesh, 4, execution), Error);
  CHECK_THROWS_AS(weights_for({}, character.mesh, 4, execution), Error);
}
