// Twist bones and helpers are recognised by their names, and the joints above stand for them.
#include <doctest/doctest.h>

#include "skeleton/rig_edits.h"

using namespace focal;

TEST_CASE("helpers of several conventions are distinguished from the bones of a body") {
  for (const char* name : {"upperarm_twist_01_l", "Bip001 LForeTwist", "CC_Base_L_ElbowShareBone",
                           "lThighTwist", "LeftForeArmRoll", "elbow_helper.R", "KneeCorrective_L"})
    CHECK(is_helper_bone(name));
  for (const char* name :
       {"upperarm_l", "Bip001 L Forearm", "lThighBend", "mixamorig:LeftArm", "troll", "tail"})
    CHECK(!is_helper_bone(name));
}

TEST_CASE("the joints above get what helpers moved, and what hung on them") {
  CharacterRig character;
  const std::pair<const char*, int32_t> bones[] = {
      {"hips", -1}, {"thigh", 0}, {"thigh_twist_01", 1}, {"thigh_twist_02", 2}, {"calf", 3}};
  for (const auto& [name, parent] : bones) {
    character.rig.joints.push_back({name, parent});
    character.rig.joints.back().bind(0, 3) = static_cast<double>(character.tip.size());
    character.tip.emplace_back(static_cast<double>(character.tip.size()), 1, 0);
    character.confidence.push_back(0.1 * static_cast<double>(character.tip.size()));
    character.rest.push_back(character.rig.joints.back().bind);
  }
  VertexInfluences all{}, calf{};
  all[0] = {2, 0.4F}, all[1] = {0, 0.3F}, all[2] = {3, 0.2F}, all[3] = {4, 0.1F};
  calf[0] = {4, 1.0F};
  character.rig.influences = {all, calf, {}};
  CHECK(drop_helper_bones(character) == std::vector<size_t>{0, 1, 4});
  const auto& joints = character.rig.joints;
  REQUIRE(joints.size() == 3);
  CHECK(joints[2].name == "calf");
  CHECK(joints[2].parent == 1);
  CHECK(joints[2].bind(0, 3) == 4);
  CHECK(character.tip[2][0] == 4);
  CHECK(character.rest[2](0, 3) == 4);
  CHECK(character.confidence[2] == doctest::Approx(0.5));
  const VertexInfluences& mixed = character.rig.influences[0];
  CHECK((mixed[0].joint == 1 && mixed[1].joint == 0 && mixed[2].joint == 2));
  CHECK(mixed[0].weight == doctest::Approx(0.6));
  CHECK(mixed[3].weight == 0);
  CHECK((character.rig.influences[1][0].joint == 2 && character.rig.influences[1][0].weight == 1));
  CHECK(character.rig.influences[2][0].weight == 0);
}

TEST_CASE("without helpers nothing changes; a root is none") {
  CharacterRig character;
  character.rig.joints = {{"root_helper", -1}, {"arm", 0}};
  character.confidence = {1, 1}, character.tip.resize(2);
  CHECK(drop_helper_bones(character) == std::vector<size_t>{0, 1});
  CHECK(character.rig.joints[1].parent == 0);
}
