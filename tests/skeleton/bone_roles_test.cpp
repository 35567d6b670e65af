// Roles follow from words and order, whatever the spelling; what is no humanoid has none.
#include "skeleton/bone_roles.h"

#include <doctest/doctest.h>

using namespace focal;

namespace {

// "name<parent" each; a root has no parent.
std::vector<Joint> skeleton(const std::vector<std::string>& lines) {
  std::vector<Joint> joints;
  for (const std::string& line : lines) {
    const size_t sign = line.find('<');
    Joint joint{line.substr(0, sign)};
    for (size_t p = 0; p < joints.size(); ++p)
      if (sign != std::string::npos && joints[p].name == line.substr(sign + 1))
        joint.parent = static_cast<int32_t>(p);
    REQUIRE((sign == std::string::npos || joint.parent >= 0));
    joints.push_back(joint);
  }
  return joints;
}

using Names = std::vector<std::string>;

Names roles(const Names& lines) { return bone_roles(skeleton(lines)); }

}  // namespace

TEST_CASE("a 3ds Max biped") {
  CHECK(
      roles({"Bip001", "Bip001 Pelvis<Bip001", "Bip001 Spine<Bip001 Pelvis", "Bip001 Spine1<Bip001 Spine",
             "Bip001 Neck<Bip001 Spine1", "Bip001 Head<Bip001 Neck", "Bip001 L Clavicle<Bip001 Neck",
             "Bip001 L UpperArm<Bip001 L Clavicle", "Bip001 L Forearm<Bip001 L UpperArm",
             "Bip001 L Hand<Bip001 L Forearm", "Bip001 R Thigh<Bip001 Pelvis", "Bip001 R Calf<Bip001 R Thigh",
             "Bip001 R Foot<Bip001 R Calf", "Bip001 R Toe0<Bip001 R Foot", "Bip001 HeadNub<Bip001 Head"}) ==
      Names{"", "hips", "spine", "chest", "neck", "head", "leftShoulder", "leftUpperArm", "leftLowerArm",
            "leftHand", "rightUpperLeg", "rightLowerLeg", "rightFoot", "rightToes", ""});
}

TEST_CASE("leg and arm are the upper or the lower bone, by what hangs above") {
  const Names mixamo =
      roles({"Hips", "Spine<Hips", "Head<Spine", "LeftUpLeg<Hips", "LeftLeg<LeftUpLeg", "LeftFoot<LeftLeg",
             "LeftShoulder<Spine", "LeftArm<LeftShoulder", "LeftForeArm<LeftArm"});
  CHECK(mixamo == Names{"hips", "spine", "head", "leftUpperLeg", "leftLowerLeg", "leftFoot", "leftShoulder",
                        "leftUpperArm", "leftLowerArm"});
  const Names other = roles({"Hips", "Spine<Hips", "Head<Spine", "Left leg<Hips", "Left knee<Left leg",
                             "Left ankle<Left knee", "Left shoulder<Spine", "Left elbow<Left shoulder",
                             "Left wrist<Left elbow"});
  CHECK(other == Names{"hips", "spine", "head", "leftUpperLeg", "leftLowerLeg", "leftFoot", "leftUpperArm",
                       "leftLowerArm", "leftHand"});
}

TEST_CASE("spines and fingers by order; twist bones, hair and controls have no role") {
  CHECK(roles({"pelvis", "spine_01<pelvis", "spine_02<spine_01", "spine_03<spine_02", "spine_04<spine_03",
               "neck_01<spine_04", "head<neck_01", "thigh_l<pelvis", "thigh_twist_01_l<thigh_l",
               "calf_l<thigh_l", "ik_foot_l<calf_l", "J_Sec_Hair1<head", "hand_r<spine_04",
               "Thumb.A.R<hand_r", "Thumb.B.R<Thumb.A.R", "Thumb.C.R<Thumb.B.R", "f_pinky.01.R<hand_r"}) ==
        Names{"hips", "spine", "chest", "upperChest", "", "neck", "head", "leftUpperLeg", "", "leftLowerLeg",
              "", "", "rightHand", "rightThumbMetacarpal", "rightThumbProximal", "rightThumbDistal",
              "rightLittleProximal"});
}

TEST_CASE("names that are no words for the bone: the convention of the file explains them") {
  CHECK(roles({"spine", "spine.001<spine", "spine.002<spine.001", "spine.004<spine.002",
               "spine.005<spine.004", "spine.006<spine.005", "shoulder.L<spine.002", "upper_arm.L<shoulder.L",
               "pelvis.L<spine", "thigh.L<spine", "shin.L<thigh.L"}) ==
        Names{"hips", "spine", "chest", "neck", "", "head", "leftShoulder", "leftUpperArm", "",
              "leftUpperLeg", "leftLowerLeg"});
  CHECK(roles({"hip", "pelvis<hip", "lThighBend<pelvis", "lThighTwist<lThighBend", "lShin<lThighTwist",
               "abdomenLower<hip", "abdomenUpper<abdomenLower", "neckLower<abdomenUpper", "head<neckLower",
               "rShldrBend<abdomenUpper", "rForearmBend<rShldrBend"}) ==
        Names{"hips", "", "leftUpperLeg", "", "leftLowerLeg", "spine", "chest", "neck", "head",
              "rightUpperArm", "rightLowerArm"});
  CHECK(roles({"CC_Base_BoneRoot", "CC_Base_Hip<CC_Base_BoneRoot", "CC_Base_Waist<CC_Base_Hip",
               "CC_Base_Spine01<CC_Base_Waist", "CC_Base_NeckTwist01<CC_Base_Spine01",
               "CC_Base_Head<CC_Base_NeckTwist01", "CC_Base_L_Thigh<CC_Base_Hip"}) ==
        Names{"", "hips", "spine", "chest", "neck", "head", "leftUpperLeg"});
  CHECK(roles({"Bip001 Pelvis", "Bip001 Head<Bip001 Pelvis", "Bip001 L UpperArm<Bip001 Pelvis",
               "Bip001 L Hand<Bip001 L UpperArm", "Bip001 L Finger0<Bip001 L Hand",
               "Bip001 L Finger11<Bip001 L Hand"}) ==
        Names{"hips", "head", "leftUpperArm", "leftHand", "leftThumbMetacarpal", "leftIndexIntermediate"});
}

TEST_CASE("animals and furniture have none") {
  CHECK(roles({"hips", "spine<hips", "neck<spine", "head<neck", "leftFrontUpperLeg<spine",
               "leftHindUpperLeg<hips", "tail1<hips"}) == Names(7, ""));
  CHECK(roles({"spine", "spine.001<spine", "spine.004<spine.001", "spine.006<spine.004", "thigh.L<spine",
               "front_thigh.L<spine.001"}) == Names(6, ""));
  CHECK(roles({"lid", "drawer"}) == Names(2, ""));
}

TEST_CASE("names by role: the metarig of Rigify, no name twice, the rest stays") {
  const auto joints = skeleton({"Hips", "Torso<Hips", "Neck<Torso", "Head<Neck", "Tail<Hips", "Horn.L<Hips",
                                "UpperLeg.L<Hips", "LowerLeg.L<UpperLeg.L"});
  size_t known = 0;
  CHECK(names_by_role(joints, BoneNames::rigify_metarig, known) ==
        Names{"spine", "spine.001", "spine.004", "spine.006", "Tail", "Horn.L", "thigh.L", "shin.L"});
  CHECK(known == 6);
  CHECK(names_by_role(joints, BoneNames::as_trained, known)[1] == "Torso");
  // A few bones of a convention are no humanoid, but are known all the same.
  CHECK(names_by_role(skeleton({"hips", "wing.L<hips"}), BoneNames::unity, known) == Names{"Hips", "wing.L"});
  CHECK(known == 1);
}
