// Joints by fitted training characters: better than what they start from, and right where that has the sides exchanged.
#include "skeleton/body_fit.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "skeleton/bone_names.h"
#include "skeleton/character_rig.h"
#include "skeleton/rig_transfer.h"
#include "skeleton/small_rig.h"

using namespace focal;
using namespace focal_test;

namespace {

// A humanoid of another build and pose than the model's, and its joints on the analysed surface.
struct Body {
  Detection detection;
  std::vector<Vector3> truth;
  std::vector<int32_t> counterpart;
  PlacedSkeleton start;  // as they are

  explicit Body(uint64_t seed) : start{rig_model()->skeleton, {}, {}, {}} {
    const creatures::Character character = humanoid(seed);
    detection = detect(rig_model(), mesh_of(character.posed, character), {}, execution);
    detection.bulge_agreement = 0;  // everything is tried
    const ToCaller to_caller(*detection.analysis);
    std::vector<Joint> joints;
    for (const SkeletonJoint& joint : rig_model()->skeleton) {
      joints.push_back({joint.name, joint.parent});
      const auto& made = character.skeleton.joints;
      for (size_t k = 0; k < made.size(); ++k)
        if (made[k].name == joint.name) {
          truth.push_back((character.pose[k] * made[k].rest - to_caller.offset) / to_caller.scale);
          start.turn.push_back(character.pose[k].linear());
        }
    }
    REQUIRE(truth.size() == joints.size());
    counterpart = other_sides(joints);
    start.place = start.tip = truth;
  }

  double error(const BodyFit& fit) const {
    double sum = 0;
    for (size_t j = 0; j < truth.size(); ++j) sum += (fit.shapes[0].posture.place[j] - truth[j]).norm();
    return sum / static_cast<double>(truth.size());
  }
  BodyFit fit(bool may_reverse, const FixedJoints& fixed = {}) const {
    return fit_to_body(detection, detection.maps, start, may_reverse, fixed, execution);
  }
};

}  // namespace

TEST_CASE("fits end near the joints of another body, and leave the heading that is right") {
  const Body body(11);
  const BodyFit fit = body.fit(true);
  CHECK_FALSE(fit.is_reversed);
  CHECK(fit.heading_margin > 0.02);
  CHECK(fit.start_share > 0);
  CHECK(body.error(fit) < 0.04);
  for (size_t i = 1; i < fit.shapes.size(); ++i) CHECK(fit.shapes[i].residual >= fit.shapes[0].residual);
}

TEST_CASE("a start whose sides are exchanged is corrected, unless the heading is known") {
  Body body(11);
  const PlacedSkeleton right = body.start;
  for (size_t j = 0; j < right.place.size(); ++j) {
    const size_t from = body.counterpart[j] < 0 ? j : static_cast<size_t>(body.counterpart[j]);
    body.start.place[j] = right.place[from];
    body.start.turn[j] = right.turn[from] * Vector3(-1, 1, -1).asDiagonal();
  }
  CHECK(body.fit(true).is_reversed);
  CHECK(body.error(body.fit(true)) < 0.05);
  CHECK_FALSE(body.fit(false).is_reversed);
}

TEST_CASE(
    "fits are overruled where the forests are sure how the body faces, and decide where these are not") {
  Body body(11);
  const BodyFit upright = body.fit(true);
  body.detection.heading_advantage = 0;
  const double by_fits = body.fit(true).heading_margin;
  CHECK(by_fits > 0.02);
  CHECK(by_fits < upright.heading_margin);
  body.detection.heading_advantage = -300;  // it was detected backwards
  CHECK(body.fit(true).is_reversed);
  CHECK_FALSE(body.fit(false).is_reversed);
}

TEST_CASE("a start whose legs alone are exchanged is corrected") {
  Body body(11);
  const PlacedSkeleton right = body.start;
  size_t exchanged = 0;
  for (size_t j = 0; j < right.place.size(); ++j) {
    const std::string& name = right.joints[j].name;
    if (name.find("Leg") == std::string::npos && name.find("Foot") == std::string::npos &&
        name.find("Toes") == std::string::npos)
      continue;
    body.start.place[j] = right.place[body.counterpart[j]],
    body.start.turn[j] = right.turn[body.counterpart[j]];
    ++exchanged;
  }
  REQUIRE(exchanged == 8);
  for (ShapeMap& map : body.detection.maps) map.map.image.clear();  // they know better
  const BodyFit fit = body.fit(true);
  CHECK_FALSE(fit.is_reversed);
  CHECK(body.error(fit) < 0.04);
}

TEST_CASE("a fixed joint that has another side says how the body faces, one in the middle does not") {
  const Body body(11);
  const auto at = [&](const char* name) {
    const auto& joints = body.start.joints;
    return static_cast<size_t>(std::find_if(joints.begin(), joints.end(),
                                            [&](const SkeletonJoint& joint) { return joint.name == name; }) -
                               joints.begin());
  };
  FixedJoints fixed(body.truth.size());
  fixed[at("hips")] = body.truth[at("hips")];
  CHECK_FALSE(body.fit(true, fixed).is_reversed);
  fixed[at("leftHand")] = body.truth[at("leftHand")];
  CHECK_FALSE(body.fit(true, fixed).is_reversed);
  fixed[at("leftHand")] = body.truth[at("rightHand")];
  CHECK(body.fit(true, fixed).is_reversed);
}

TEST_CASE("landmarks whose sides are exchanged: the rig is right all the same, and says so") {
  Body body(11);
  Detection& found = body.detection;
  const std::vector<SurfacePoint> places = found.places;
  const auto& names = found.model->landmark_names;
  size_t exchanged = 0;
  for (size_t l = 0; l < names.size(); ++l)
    if (const auto mirrored = mirrored_name(names[l]))
      if (const auto at = std::find(names.begin(), names.end(), *mirrored); at != names.end())
        found.places[l] = places[static_cast<size_t>(at - names.begin())], ++exchanged;
  REQUIRE(exchanged > 10);
  found.maps.clear();  // made anew from the places
  const auto says_so = [](const CharacterRig& rig) {
    return std::any_of(rig.warnings.begin(), rig.warnings.end(), [](const std::string& one) {
      return one.find("faces the other way") != std::string::npos;
    });
  };
  const CharacterRig rig = transfer_rig(found, execution);
  CHECK(says_so(rig));
  const ToCaller to_caller(*found.analysis);
  double sum = 0;
  for (size_t j = 0; j < body.truth.size(); ++j)
    sum += (Vector3(rig.rig.joints[j].bind.topRightCorner<3, 1>()) - to_caller(body.truth[j])).norm();
  CHECK(sum / to_caller.scale < 0.05 * static_cast<double>(body.truth.size()));
  found.has_fixed = true;  // then the landmarks are right
  CHECK_FALSE(says_so(transfer_rig(found, execution)));
}

TEST_CASE("maps of fits lead from the points to where they lie") {
  const Body body(11);
  const BodyFit fit = body.fit(true);
  const auto maps = maps_of_fits(fit, *rig_model(), *body.detection.analysis, execution);
  REQUIRE(maps.size() == fit.shapes.size());
  for (size_t m = 0; m < maps.size(); ++m) {
    CHECK(maps[m].shape == fit.shapes[m].shape);
    REQUIRE(static_cast<Eigen::Index>(maps[m].map.image.size()) == fit.shapes[m].points.rows());
    for (Eigen::Index i = 0; i < fit.shapes[m].points.rows(); ++i)
      CHECK((body.detection.analysis->surface().positions.row(maps[m].map.image[i]) -
             fit.shapes[m].points.row(i))
                .norm() < 0.3);
  }
}
