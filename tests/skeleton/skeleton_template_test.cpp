// A skeleton written by hand over known landmarks: joints come to lie where they should, and what makes no sense is refused.
#include "skeleton/skeleton_template.h"

#include <doctest/doctest.h>

#include "base/error.h"
#include "mesh/section.h"
#include "skeleton/bone_names.h"
#include "skeleton/small_rig.h"

using namespace focal;
using namespace focal_test;

namespace {

const Detection& detection() {
  static const Detection one = [] {
    const creatures::Character other = humanoid(11);
    return detect(rig_model(), mesh_of(other.posed, other), {}, execution);
  }();
  return one;
}

// The landmarks round a joint of the characters that taught the model.
std::vector<std::string> round_joint(const std::string& joint) {
  std::vector<std::string> names;
  for (const std::string& name : rig_model()->landmark_names)
    if (name.starts_with(joint + " ") && !name.ends_with("tip")) names.push_back(name);
  REQUIRE_FALSE(names.empty());
  return names;
}

// Knees and feet, each joint in the middle of the limb under its landmarks.
SkeletonTemplate limbs() {
  SkeletonTemplate skeleton;
  skeleton.joints.push_back({.name = "middle", .between = {"leftLowerLeg", "rightLowerLeg"}});
  for (const std::string side : {"left", "right"}) {
    skeleton.joints.push_back(
        {.name = side + "LowerLeg", .parent = "middle", .centre = round_joint(side + "LowerLeg")});
    skeleton.joints.push_back(
        {.name = side + "Foot", .parent = "middle", .centre = round_joint(side + "Foot")});
  }
  return skeleton;
}

}  // namespace

TEST_CASE("joints lie in the middle of the limbs, weights sum to one") {
  const CharacterRig found = rig_by_template(limbs(), detection(), execution);
  CHECK(found.warnings.empty());
  CHECK(found.rest.empty());
  const creatures::Character truth = humanoid(11);
  const double height = truth.posed.empty() ? 0
                                            : detection().mesh->source.positions.col(1).maxCoeff() -
                                                  detection().mesh->source.positions.col(1).minCoeff();
  for (const Joint& joint : found.rig.joints) {
    CHECK(winding_number(detection().mesh->source, place_of(joint)) > 0.5);
    for (size_t t = 0; t < truth.skeleton.joints.size(); ++t)
      if (truth.skeleton.joints[t].name == joint.name)
        CHECK((place_of(joint) - truth.pose[t] * truth.skeleton.joints[t].rest).norm() < 0.04 * height);
  }
  for (const VertexInfluences& one : found.rig.influences) {
    float sum = 0;
    for (const Influence& influence : one) sum += influence.weight;
    CHECK(sum == doctest::Approx(1).epsilon(1e-5));
  }
}

TEST_CASE("a joint's y axis points along its bone; a rest pose turns it to where the template says") {
  SkeletonTemplate skeleton = limbs();
  skeleton.joints[1].rest = Vector3(-1, 0, 0);
  const CharacterRig found = rig_by_template(skeleton, detection(), execution);
  for (size_t j = 0; j < found.rig.joints.size(); ++j) {
    const Matrix3 turn = found.rig.joints[j].bind.topLeftCorner<3, 3>();
    CHECK((turn.transpose() * turn - Matrix3::Identity()).norm() < 1e-9);
  }
  const Vector3 bone = (found.tip[1] - place_of(found.rig.joints[1])).normalized();
  CHECK(found.rig.joints[1].bind.col(1).head<3>().dot(bone) == doctest::Approx(1));
  REQUIRE(found.rest.size() == found.rig.joints.size());
  CHECK((found.rest[1].col(1).head<3>() - Vector3(-1, 0, 0)).norm() < 1e-9);
}

TEST_CASE("both sides get bones of one length where the template is symmetric") {
  SkeletonTemplate skeleton = limbs();
  skeleton.symmetric = true;
  const CharacterRig found = rig_by_template(skeleton, detection(), execution);
  const auto length = [&](size_t j) {
    return (place_of(found.rig.joints[j]) - place_of(found.rig.joints[0])).norm();
  };
  CHECK(found.rig.joints[1].name == "leftLowerLeg");
  CHECK(found.rig.joints[3].name == "rightLowerLeg");
  CHECK(length(1) == doctest::Approx(length(3)));
  CHECK(length(2) == doctest::Approx(length(4)));
}

TEST_CASE("a joint whose landmarks are absent lies at its parent, and that is told") {
  Detection partly = detection();
  for (size_t l = 0; l < partly.places.size(); ++l)
    if (rig_model()->landmark_names[l].starts_with("leftFoot ")) partly.places[l].triangle = -1;
  const CharacterRig found = rig_by_template(limbs(), partly, execution);
  REQUIRE(found.warnings.size() == 1);
  CHECK(found.warnings[0].find("'leftFoot'") != std::string::npos);
  CHECK((place_of(found.rig.joints[2]) - place_of(found.rig.joints[0])).norm() == 0);
  CHECK(found.confidence[2] == 0);
  for (SurfacePoint& place : partly.places) place.triangle = -1;
  CHECK_THROWS_AS(rig_by_template(limbs(), partly, execution), Error);
}

TEST_CASE("templates that make no sense are refused, by the joint's name") {
  const auto refused = [](const char* what, auto&& spoil) {
    SkeletonTemplate skeleton = limbs();
    spoil(skeleton.joints);
    try {
      rig_by_template(skeleton, detection(), execution);
    } catch (const Error& error) {
      CHECK(error.status() == Status::invalid_argument);
      CAPTURE(what);
      CAPTURE(std::string(error.what()));
      CHECK(std::string(error.what()).find(what) != std::string::npos);
      return;
    }
    FAIL("taken: " << what);
  };
  using Joints = std::vector<TemplateJoint>;
  refused("no joints", [](Joints& joints) { joints.clear(); });
  refused("has no name", [](Joints& joints) { joints[2].name = ""; });
  refused("occurs twice", [](Joints& joints) { joints[2].name = joints[1].name; });
  refused("does not come before it", [](Joints& joints) { joints[1].parent = joints[2].name; });
  refused("exactly one position", [](Joints& joints) { joints[1].centre.clear(); });
  refused("exactly one position", [](Joints& joints) { joints[1].surface = joints[1].centre; });
  refused("'elbow'", [](Joints& joints) { joints[1].centre = {"elbow"}; });
  refused("exactly two places", [](Joints& joints) { joints[0].between.pop_back(); });
  refused("exactly two places", [](Joints& joints) { joints[0].share = 1.5; });
  refused("depends on itself", [](Joints& joints) {
    joints[1].centre.clear(), joints[1].between = {"middle", joints[2].name};
  });
}

TEST_CASE("the other side's name") {
  CHECK(mirrored_name("leftHand") == "rightHand");
  CHECK(mirrored_name("RightFoot") == "LeftFoot");
  CHECK(mirrored_name("hand.L") == "hand.R");
  CHECK(mirrored_name("upperarm_r") == "upperarm_l");
  CHECK(mirrored_name("L_eye") == "R_eye");
  CHECK_FALSE(mirrored_name("hips").has_value());
  CHECK_FALSE(mirrored_name("tail").has_value());
  CHECK_FALSE(mirrored_name("").has_value());
}
