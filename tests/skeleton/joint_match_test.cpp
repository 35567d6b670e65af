// Joints of different files find each other by their names.
#include "skeleton/joint_match.h"

#include <doctest/doctest.h>

using namespace focal;

namespace {

using Names = std::vector<std::string>;

// The names that were found, "" where none was.
Names found(const Names& wanted, const Names& names) {
  Names result;
  for (const int32_t there : match_joints(wanted, names).there)
    result.push_back(there < 0 ? "" : names[there]);
  return result;
}

// The same bones of a humanoid as several programs call them.
const Names vrm = {"hips",          "spine",         "head",         "leftUpperArm", "leftLowerArm",
                   "rightUpperArm", "rightLowerArm", "leftUpperLeg", "rightUpperLeg"};
const std::vector<Names> others = {
    {"mixamorig:Hips", "mixamorig:Spine", "mixamorig:Head", "mixamorig:LeftArm", "mixamorig:LeftForeArm",
     "mixamorig:RightArm", "mixamorig:RightForeArm", "mixamorig:LeftUpLeg", "mixamorig:RightUpLeg"},
    {"pelvis", "spine_01", "head", "upperarm_l", "lowerarm_l", "upperarm_r", "lowerarm_r", "thigh_l",
     "thigh_r"},
    {"DEF-spine", "DEF-spine.001", "DEF-spine.006", "DEF-upper_arm.L", "DEF-forearm.L", "DEF-upper_arm.R",
     "DEF-forearm.R", "DEF-thigh.L", "DEF-thigh.R"},
    {"spine", "spine.001", "spine.006", "upper_arm.L", "forearm.L", "upper_arm.R", "forearm.R", "thigh.L",
     "thigh.R"},
    {"Hips", "Spine", "Head", "LeftUpperArm", "LeftLowerArm", "RightUpperArm", "RightLowerArm",
     "LeftUpperLeg", "RightUpperLeg"},
    {"Bip001 Pelvis", "Bip001 Spine", "Bip001 Head", "Bip001 L UpperArm", "Bip001 L Forearm",
     "Bip001 R UpperArm", "Bip001 R Forearm", "Bip001 L Thigh", "Bip001 R Thigh"},
    {"hip", "abdomenLower", "head", "lShldrBend", "lForearmBend", "rShldrBend", "rForearmBend", "lThighBend",
     "rThighBend"},
    {"CC_Base_Hip", "CC_Base_Waist", "CC_Base_Head", "CC_Base_L_Upperarm", "CC_Base_L_Forearm",
     "CC_Base_R_Upperarm", "CC_Base_R_Forearm", "CC_Base_L_Thigh", "CC_Base_R_Thigh"},
    {"Hips", "Abdomen", "Head", "UpperArm.L", "LowerArm.L", "UpperArm.R", "LowerArm.R", "UpperLeg.L",
     "UpperLeg.R"},
    {"hips", "spine", "head", "upperarm.l", "lowerarm.l", "upperarm.r", "lowerarm.r", "upperleg.l",
     "upperleg.r"}};

}  // namespace

TEST_CASE("names are matched as written, then without prefixes") {
  CHECK(found({"a", "b"}, {"b", "a", "c"}) == Names{"a", "b"});
  CHECK(found({"mixamorig:Hips", "mixamorig:Head"}, {"mixamorig9:Head", "mixamorig9:Hips"}) ==
        Names{"mixamorig9:Hips", "mixamorig9:Head"});
  CHECK(found({"Hips", "Head"}, {"Armature_mixamorig1:Hips", "Armature_mixamorig1:Head"}) ==
        Names{"Armature_mixamorig1:Hips", "Armature_mixamorig1:Head"});
  CHECK(found({"rig_a", "rig_b"}, {"x:a", "x:b"}) == Names{"x:a", "x:b"});
  const JointMatch none = match_joints({"tail", "wing"}, {"rotor", "wing"});
  CHECK(none.there == std::vector<int32_t>{-1, 1});
  CHECK(none.missing == Names{"tail"});
}

TEST_CASE("bones of a humanoid are matched between all conventions, side by side") {
  for (const Names& names : others) {
    CAPTURE(names[3]);
    CHECK(found(vrm, names) == names);
    CHECK(found(names, vrm) == vrm);
    CHECK(match_joints(vrm, names).by_convention[3] == 1);  // its axes may be others
  }
  for (const Names& from : others)
    for (const Names& to : others) {
      CAPTURE(from[3]);
      CAPTURE(to[3]);
      CHECK(found(from, to) == to);
    }
}

TEST_CASE("no joint is found twice, and a name of another thing is none") {
  const Names names = found({"Spine", "spine"}, {"spine", "Spine"});
  CHECK(names == Names{"Spine", "spine"});
  CHECK(found({"Bright", "cleft"}, {"B", "c"}) == Names{"", ""});
}
