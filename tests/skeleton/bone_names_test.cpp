// Every bone has one name in each convention, and they lead back to it.
#include "skeleton/bone_names.h"

#include <doctest/doctest.h>

#include <set>

using namespace focal;

TEST_CASE("known bones in every convention") {
  CHECK(bone_name("leftUpperArm", BoneNames::mixamo) == "mixamorig:LeftArm");
  CHECK(bone_name("mixamorig:RightForeArm", BoneNames::unreal) == "lowerarm_r");
  CHECK(bone_name("calf_l", BoneNames::rigify) == "DEF-shin.L");
  CHECK(bone_name("DEF-spine", BoneNames::vrm) == "hips");
  CHECK(bone_name("RightHandPinky2", BoneNames::vrm) == "rightLittleIntermediate");
  CHECK(bone_name("head", BoneNames::unity) == "Head");
  CHECK(bone_name("Tail3", BoneNames::as_trained) == "Tail3");
  CHECK_FALSE(bone_name("Tail3", BoneNames::vrm).has_value());
}

TEST_CASE("there and back again, and no two bones share a name") {
  const std::vector<std::string> bones = {"hips",
                                          "spine",
                                          "chest",
                                          "upperChest",
                                          "neck",
                                          "head",
                                          "leftShoulder",
                                          "rightShoulder",
                                          "leftUpperArm",
                                          "rightLowerArm",
                                          "leftHand",
                                          "leftUpperLeg",
                                          "rightLowerLeg",
                                          "leftFoot",
                                          "rightToes",
                                          "leftThumbMetacarpal",
                                          "rightIndexDistal",
                                          "leftLittleProximal"};
  for (const auto convention : {BoneNames::mixamo, BoneNames::unreal, BoneNames::rigify, BoneNames::unity}) {
    std::set<std::string> names;
    for (const std::string& bone : bones) {
      const auto name = bone_name(bone, convention);
      REQUIRE(name);
      CHECK(names.insert(*name).second);
      CHECK(bone_name(*name, BoneNames::vrm) == bone);
    }
  }
  CHECK(bone_name("leftUpperLeg", BoneNames::rigify_metarig) == "thigh.L");
}
