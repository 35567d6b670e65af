// A rig that follows its characters is not refused; one that is crumpled is not good, whatever it is that is wrong.
#include "skeleton/verdict.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "skeleton/rig_transfer.h"
#include "skeleton/small_rig.h"

using namespace focal;
using namespace focal_test;

namespace {

struct Rigged {
  Detection detection;
  CharacterRig rig;
};

// A humanoid of another build and pose than the model's.
const Rigged& other() {
  static const Rigged one = [] {
    const creatures::Character character = humanoid(11);
    Detection detection = detect(rig_model(), mesh_of(character.posed, character), {}, execution);
    CharacterRig rig = transfer_rig(detection, execution);
    return Rigged{std::move(detection), std::move(rig)};
  }();
  return one;
}

Eigen::Block<Matrix4, 3, 1> place(CharacterRig& rig, const std::string& name) {
  const auto at = std::find_if(rig.rig.joints.begin(), rig.rig.joints.end(),
                               [&](const Joint& joint) { return joint.name == name; });
  REQUIRE(at != rig.rig.joints.end());
  return at->bind.topRightCorner<3, 1>();
}

RigMeasures measures(const CharacterRig& rig) { return rig_measures(other().detection, rig); }

bool doubts(const RigMeasures& measures, const std::string& words) {
  for (const std::string& doubt : doubts_about(measures))
    if (doubt.find(words) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("nothing measured, nothing wrong") {
  const RigMeasures none;
  CHECK(rig_quality(none) == 1);
  CHECK(verdict_of(none) == Verdict::good);
  CHECK(doubts_about(none).empty());
  CHECK(std::string(name_of(Verdict::check)) == "check");
}

TEST_CASE("the worse a measure, the lower the quality; all bad: failed, with the worst doubt first") {
  RigMeasures all;
  const std::vector<std::pair<double RigMeasures::*, std::vector<double>>> worse = {
      {&RigMeasures::category_fit, {1, 0.1, 0}},
      {&RigMeasures::map_residual, {0.1, 0.7, 2}},
      {&RigMeasures::bulge_agreement, {0.8, 0.1, -0.5}},
      {&RigMeasures::cost_margin, {1e9, 1, 0}},
      {&RigMeasures::surface_distance, {0, 0.06, 1}},
      {&RigMeasures::heading_margin, {1, 0.03, 0}},
      {&RigMeasures::joint_spread, {0, 0.7, 1}},
      {&RigMeasures::absent_share, {0, 0.4, 1}},
      {&RigMeasures::uncovered, {0, 0.1, 1}},
      {&RigMeasures::outside_share, {0, 0.05, 1}},
      {&RigMeasures::long_share, {0, 0.04, 1}},
      {&RigMeasures::collapsed_share, {0, 0.1, 1}},
      {&RigMeasures::merged_share, {0, 0.1, 1}},
      {&RigMeasures::crossed_share, {0, 0.2, 1}},
      {&RigMeasures::bone_strain, {0, 0.3, 5}}};
  for (const auto& [measure, values] : worse) {
    RigMeasures one;
    double before = 2;
    for (const double value : values) {
      one.*measure = value;
      CHECK(rig_quality(one) < before);
      CHECK(rig_quality(one) > 0);
      before = rig_quality(one);
    }
    CHECK(doubts_about(one).size() == 1);
    all.*measure = values[2];
  }
  RigMeasures alone;
  alone.cost_margin = alone.heading_margin = std::numeric_limits<double>::infinity();
  CHECK(rig_quality(alone) == 1);
  CHECK(verdict_of(all) == Verdict::failed);
  CHECK(doubts_about(all).size() == worse.size());
}

TEST_CASE("a humanoid's rig is measured and not refused") {
  const RigMeasures found = measures(other().rig);
  CAPTURE(found.joint_spread);
  CAPTURE(found.bone_strain);
  CAPTURE(found.uncovered);
  CHECK(verdict_of(found) != Verdict::failed);
  CHECK(found.absent_share == 0);
  CHECK(found.map_residual > 0);
  CHECK(found.uncovered > 0);
  CHECK(found.uncovered < 0.1);
  CHECK(found.bone_strain < 0.4);
  for (const double share : {found.outside_share, found.long_share, found.collapsed_share, found.merged_share,
                             found.crossed_share})
    CHECK(share == 0);
}

TEST_CASE("joints all in one place, scattered or turned about: not good") {
  const double before = rig_quality(measures(other().rig));
  CharacterRig heap = other().rig;
  const Vector3 middle = place(heap, "spine");
  for (Joint& joint : heap.rig.joints) joint.bind.topRightCorner<3, 1>() = middle;
  CHECK(verdict_of(measures(heap)) == Verdict::failed);
  CHECK(measures(heap).merged_share > 0.9);
  CHECK(doubts(measures(heap), "no length"));

  CharacterRig shrunk = other().rig;
  for (Joint& joint : shrunk.rig.joints)
    joint.bind.topRightCorner<3, 1>() = middle + 0.2 * (joint.bind.topRightCorner<3, 1>() - middle);
  CHECK(verdict_of(measures(shrunk)) != Verdict::good);
  CHECK(measures(shrunk).bone_strain > 1);

  CharacterRig swapped = other().rig;  // arms that begin on one side and end on the other
  for (const std::string part : {"LowerArm", "Hand"}) {
    const Vector3 left = place(swapped, "left" + part);
    place(swapped, "left" + part) = Vector3(place(swapped, "right" + part));
    place(swapped, "right" + part) = left;
  }
  CHECK(measures(swapped).crossed_share > 0);
  CHECK(rig_quality(measures(swapped)) < before);
}

TEST_CASE("a joint far outside, a bone as long as the body, a hand upon the other: the quality falls") {
  const double before = rig_quality(measures(other().rig));
  const MatrixX3& positions = other().detection.mesh->source.positions;
  const double height = (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).maxCoeff();
  CharacterRig far = other().rig;
  place(far, "leftHand") += Vector3(0, 2 * height, 0);
  CHECK(measures(far).outside_share > 0);
  CHECK(measures(far).long_share > 0);
  CHECK(doubts(measures(far), "outside"));
  CHECK(rig_quality(measures(far)) < 0.9 * before);
  far.rig.influences.assign(far.rig.influences.size(), VertexInfluences{});  // a control that moves nothing
  CHECK(measures(far).outside_share == 0);

  CharacterRig clasped = other().rig;
  place(clasped, "leftHand") = Vector3(place(clasped, "rightHand"));
  CHECK(measures(clasped).merged_share > 0);
  CHECK(rig_quality(measures(clasped)) < before);
}

TEST_CASE(
    "a joint is as sure as the rig is good and the training characters agree; what is given or missing stays "
    "so") {
  const auto confidence = [](double quality, double agreement, const FixedJoints& fixed = {}) {
    CharacterRig rig;
    rig.confidence = {agreement};
    calibrate_confidence(quality, fixed, rig);
    return rig.confidence[0];
  };
  CHECK(confidence(0.01, 1) < 0.2);
  CHECK(confidence(1, 1) > 0.8);
  for (double quality = 0.1; quality < 0.95; quality += 0.1) {
    CHECK(confidence(quality, 1) < confidence(quality + 0.05, 1));
    CHECK(confidence(quality, 0.2) < confidence(quality, 0.4));
    CHECK(confidence(quality, 0) == 0);
    CHECK(confidence(quality, 1, {Vector3::Zero()}) == 1);
  }
}

TEST_CASE("joints without a found landmark count as guesses") {
  Detection detection = other().detection;
  CHECK(guessed_joints(detection).empty());
  for (size_t l = 0; l < detection.places.size(); ++l)
    if (rig_model()->landmark_names[l].starts_with("leftHand ")) detection.places[l].triangle = -1;
  CHECK(guessed_joints(detection) == std::vector<std::string>{"leftHand"});
  CHECK(rig_measures(detection, other().rig).absent_share ==
        doctest::Approx(1.0 / static_cast<double>(other().rig.rig.joints.size())));
  for (SurfacePoint& point : detection.places) point.triangle = -1;
  CHECK(guessed_joints(detection).size() > 10);
  CHECK(rig_quality(rig_measures(detection, other().rig)) < rig_quality(measures(other().rig)));
}
