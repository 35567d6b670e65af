// One rigged sample humanoid teaches a skeleton, which is put on others, of other build and pose.
#include "skeleton/rig_transfer.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "base/error.h"
#include "model/model_file.h"
#include "skeleton/rig_landmarks.h"
#include "skeleton/small_rig.h"

using namespace focal;
using namespace focal_test;

namespace {

double height(const TriangleMesh& mesh) {
  return mesh.positions.col(1).maxCoeff() - mesh.positions.col(1).minCoeff();
}

}  // namespace

TEST_CASE("landmarks follow from a skeleton: the same points on copies in other poses") {
  const TrainingSet set = training_set_of({rigged(humanoid(1))}, {.shapes = 4, .landmarks = 40});
  REQUIRE(set.shapes.size() == 4);
  CHECK(set.landmark_names.size() >= 25);
  CHECK(set.landmark_names.size() <= 40);
  CHECK(set.skeleton.size() == humanoid(1).skeleton.joints.size());
  for (const MarkedShape& shape : set.shapes) {
    CHECK(std::count_if(shape.marks.begin(), shape.marks.end(), [](const auto& m) {
            return m.has_value();
          }) == static_cast<std::ptrdiff_t>(set.landmark_names.size()));
    // A joint's ring stays round the joint: its marks lie no farther than a limb is thick.
    for (size_t l = 0; l < set.landmark_names.size(); ++l) {
      const std::string& name = set.landmark_names[l];
      if (name.find("LowerArm ") == std::string::npos || name.ends_with("tip")) continue;
      for (size_t j = 0; j < set.skeleton.size(); ++j)
        if (name.starts_with(set.skeleton[j].name + " "))
          CHECK(
              (position_of(shape.mesh->surface, *shape.marks[l]) - shape.rig->bind[j]->topRightCorner<3, 1>())
                  .norm() < 0.12);
    }
  }
}

TEST_CASE("another humanoid in another pose gets its skeleton and weights") {
  for (const uint64_t seed : {11, 12}) {
    const creatures::Character other = humanoid(seed);
    const auto mesh = mesh_of(other.posed, other);
    const Detection detection = detect(rig_model(), mesh, {}, execution);
    const CharacterRig found = transfer_rig(detection, execution);
    REQUIRE(found.rig.joints.size() == other.skeleton.joints.size());
    double error = 0;
    for (const Joint& joint : found.rig.joints)
      for (size_t t = 0; t < other.skeleton.joints.size(); ++t)
        if (other.skeleton.joints[t].name == joint.name)
          error += (joint.bind.topRightCorner<3, 1>() - other.pose[t] * other.skeleton.joints[t].rest).norm();
    CHECK(error / static_cast<double>(found.rig.joints.size()) < 0.04 * height(mesh->source));
    for (size_t j = 0; j < found.rest.size();
         ++j) {  // bones keep their lengths; the sample's joints are not turned at rest
      const int32_t p = found.rig.joints[j].parent;
      CHECK((found.rest[j].topLeftCorner<3, 3>() - Matrix3::Identity()).norm() < 1e-5);
      if (p < 0) continue;
      const auto length = [&](const Matrix4& a, const Matrix4& b) {
        return (a.topRightCorner<3, 1>() - b.topRightCorner<3, 1>()).norm();
      };
      CHECK(length(found.rest[j], found.rest[p]) ==
            doctest::Approx(length(found.rig.joints[j].bind, found.rig.joints[p].bind)));
    }
    double difference = 0;
    for (size_t v = 0; v < found.rig.influences.size(); ++v) {
      float sum = 0;
      std::vector<double> weight(found.rig.joints.size(), 0);
      for (const Influence& one : found.rig.influences[v]) sum += one.weight, weight[one.joint] += one.weight;
      CHECK(sum == doctest::Approx(1).epsilon(1e-5));
      for (int k = 0; k < creatures::max_influences; ++k)
        for (size_t j = 0; j < weight.size(); ++j)
          if (found.rig.joints[j].name == other.skeleton.joints[other.skin[v].joints[k]].name)
            weight[j] -= other.skin[v].weights[k];
      for (const double w : weight) difference += std::abs(w);
    }
    CHECK(difference / static_cast<double>(found.rig.influences.size()) < 0.5);
  }
}

TEST_CASE("a joint without any landmark of its own is named; too few landmarks without maps are refused") {
  const creatures::Character other = humanoid(11);
  Detection detection = detect(rig_model(), mesh_of(other.posed, other), {}, execution);
  CHECK(transfer_rig(detection, execution).warnings.empty());
  for (size_t l = 0; l < detection.places.size(); ++l)
    if (rig_model()->landmark_names[l].starts_with("leftHand ")) detection.places[l].triangle = -1;
  const auto warnings = transfer_rig(detection, execution).warnings;
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].find("'leftHand'") != std::string::npos);
  for (SurfacePoint& place : detection.places) place.triangle = -1;
  CHECK(transfer_rig(detection, execution).warnings.size() == 1);  // the maps say where the joints are
  detection.maps.clear();
  CHECK_THROWS_AS(transfer_rig(detection, execution), Error);
  detection.analysis = nullptr;
  CHECK_THROWS_AS(transfer_rig(detection, execution), Error);
}

TEST_CASE("a model with a skeleton goes through its file and rigs the same") {
  const auto bytes = serialise(*rig_model());
  const auto loaded = std::make_shared<const LandmarkModel>(parse_model(bytes));
  REQUIRE(loaded->skeleton.size() == rig_model()->skeleton.size());
  CHECK(loaded->skeleton[3].name == rig_model()->skeleton[3].name);
  CHECK(loaded->skeleton[3].parent == rig_model()->skeleton[3].parent);
  CHECK(serialise(*loaded) == bytes);
  auto damaged = bytes;
  damaged.resize(damaged.size() - 1);
  CHECK_THROWS_AS(parse_model(damaged), Error);
}

TEST_CASE("characters without weights, or a model without a skeleton, are refused with a hint") {
  CHECK_THROWS_AS(training_set_of({}), Error);
  RiggedMesh idle = rigged(humanoid(1));
  for (auto& influences : idle.rig.influences) influences = {};
  CHECK_THROWS_AS(training_set_of({idle}), Error);
}

TEST_CASE("controls that move nothing are left out, joints that others lack hand their weights on") {
  RiggedMesh one = rigged(humanoid(1)), two = one, three = one;
  for (RiggedMesh* character : {&one, &two, &three})
    character->rig.joints.push_back({"poleTarget", 0, Matrix4::Identity()});
  // An extra joint of one character alone takes over the left hand's vertices.
  const auto hand = static_cast<int32_t>(std::find_if(one.rig.joints.begin(), one.rig.joints.end(),
                                                      [](const Joint& j) { return j.name == "leftHand"; }) -
                                         one.rig.joints.begin());
  REQUIRE(hand < static_cast<int32_t>(one.rig.joints.size()));
  one.rig.joints.push_back({"extra", hand, Matrix4::Identity()});
  const auto extra = static_cast<int32_t>(one.rig.joints.size()) - 1;
  for (auto& influences : one.rig.influences)
    for (Influence& i : influences)
      if (i.joint == hand && i.weight > 0) i.joint = extra;
  const TrainingSet set = training_set_of({one, two, three}, {.shapes = 3, .landmarks = 10});
  for (const SkeletonJoint& joint : set.skeleton)
    CHECK((joint.name != "poleTarget" && joint.name != "extra"));
  CHECK(set.shapes[0].rig->influences[100][0].joint == set.shapes[1].rig->influences[100][0].joint);
  const RowMatrixf a = weights_below(set.skeleton, set.shapes[0].rig->influences),
                   b = weights_below(set.skeleton, set.shapes[1].rig->influences);
  CHECK((a - b).cwiseAbs().maxCoeff() < 1e-5);
}
