#include "skeleton/bone_names.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace focal {
namespace {

// One bone: VRM, Mixamo (without its prefix), Unreal mannequin, Rigify's deforming bones. %: the side, as each writes it.
struct Bone {
  const char *vrm, *mixamo, *unreal, *rigify;
};

constexpr Bone middle[] = {
    {"hips", "Hips", "pelvis", "DEF-spine"},
    {"spine", "Spine", "spine_01", "DEF-spine.001"},
    {"chest", "Spine1", "spine_02", "DEF-spine.002"},
    {"upperChest", "Spine2", "spine_03", "DEF-spine.003"},
    {"neck", "Neck", "neck_01", "DEF-spine.004"},
    {"head", "Head", "head", "DEF-spine.006"},
    {"jaw", "Jaw", "jaw", "DEF-jaw"},
};

constexpr Bone sided[] = {
    {"%Eye", "%Eye", "eye_%", "DEF-eye.%"},
    {"%Shoulder", "%Shoulder", "clavicle_%", "DEF-shoulder.%"},
    {"%UpperArm", "%Arm", "upperarm_%", "DEF-upper_arm.%"},
    {"%LowerArm", "%ForeArm", "lowerarm_%", "DEF-forearm.%"},
    {"%Hand", "%Hand", "hand_%", "DEF-hand.%"},
    {"%UpperLeg", "%UpLeg", "thigh_%", "DEF-thigh.%"},
    {"%LowerLeg", "%Leg", "calf_%", "DEF-shin.%"},
    {"%Foot", "%Foot", "foot_%", "DEF-foot.%"},
    {"%Toes", "%ToeBase", "ball_%", "DEF-toe.%"},
    {"%ThumbMetacarpal", "%HandThumb1", "thumb_01_%", "DEF-thumb.01.%"},
    {"%ThumbProximal", "%HandThumb2", "thumb_02_%", "DEF-thumb.02.%"},
    {"%ThumbDistal", "%HandThumb3", "thumb_03_%", "DEF-thumb.03.%"},
    {"%IndexProximal", "%HandIndex1", "index_01_%", "DEF-f_index.01.%"},
    {"%IndexIntermediate", "%HandIndex2", "index_02_%", "DEF-f_index.02.%"},
    {"%IndexDistal", "%HandIndex3", "index_03_%", "DEF-f_index.03.%"},
    {"%MiddleProximal", "%HandMiddle1", "middle_01_%", "DEF-f_middle.01.%"},
    {"%MiddleIntermediate", "%HandMiddle2", "middle_02_%", "DEF-f_middle.02.%"},
    {"%MiddleDistal", "%HandMiddle3", "middle_03_%", "DEF-f_middle.03.%"},
    {"%RingProximal", "%HandRing1", "ring_01_%", "DEF-f_ring.01.%"},
    {"%RingIntermediate", "%HandRing2", "ring_02_%", "DEF-f_ring.02.%"},
    {"%RingDistal", "%HandRing3", "ring_03_%", "DEF-f_ring.03.%"},
    {"%LittleProximal", "%HandPinky1", "pinky_01_%", "DEF-f_pinky.01.%"},
    {"%LittleIntermediate", "%HandPinky2", "pinky_02_%", "DEF-f_pinky.02.%"},
    {"%LittleDistal", "%HandPinky3", "pinky_03_%", "DEF-f_pinky.03.%"},
};

std::string with_side(std::string name, const char* side) {
  if (const size_t at = name.find('%'); at != std::string::npos) name.replace(at, 1, side);
  return name;
}

// The bone in every convention, by BoneNames less one.
using Names = std::array<std::string, 6>;

Names names_of(const Bone& bone, bool left) {
  Names names{with_side(bone.vrm, left ? "left" : "right"),
              "mixamorig:" + with_side(bone.mixamo, left ? "Left" : "Right"),
              with_side(bone.unreal, left ? "l" : "r"),
              with_side(bone.rigify, left ? "L" : "R"),
              "",
              ""};
  names[4] = names[0];
  names[4][0] = static_cast<char>(std::toupper(static_cast<unsigned char>(names[4][0])));
  names[5] = names[3].substr(4);  // without DEF-
  return names;
}

std::vector<Names> all_bones() {
  std::vector<Names> bones;
  for (const Bone& bone : middle) bones.push_back(names_of(bone, true));
  for (const Bone& bone : sided)
    for (const bool left : {true, false}) bones.push_back(names_of(bone, left));
  return bones;
}

bool is_called(const Names& names, const std::string& name) {
  constexpr size_t understood = 5;  // not the metarig's: there `spine` are the hips
  if (std::find(names.begin(), names.begin() + understood, name) != names.begin() + understood) return true;
  return names[1] == "mixamorig:" + name;  // the prefix is often dropped
}

}  // namespace

std::optional<std::string> bone_name(const std::string& name, BoneNames convention) {
  if (convention == BoneNames::as_trained) return name;
  for (const Names& names : all_bones())
    if (is_called(names, name)) return names[static_cast<size_t>(convention) - 1];
  return std::nullopt;
}

std::optional<std::string> mirrored_name(const std::string& name) {
  struct Sides {
    std::string from, to;
  };
  static const std::vector<Sides> words = {{"left", "right"}, {"right", "left"}, {"Left", "Right"},
                                           {"Right", "Left"}, {"LEFT", "RIGHT"}, {"RIGHT", "LEFT"}};
  static const std::vector<Sides> letters = {{"L", "R"}, {"R", "L"}, {"l", "r"}, {"r", "l"}};
  const auto is_letter = [&](size_t at) {
    return at < name.size() && std::isalpha(static_cast<unsigned char>(name[at]));
  };
  const auto swapped = [&](size_t at, const Sides& sides) {
    return name.substr(0, at) + sides.to + name.substr(at + sides.from.size());
  };
  for (const Sides& sides : words)
    for (size_t at = name.find(sides.from); at != std::string::npos; at = name.find(sides.from, at + 1))
      // "bright" and "cleft" have no side.
      if (at == 0 || !is_letter(at - 1) ||
          (std::isupper(static_cast<unsigned char>(name[at])) &&
           std::islower(static_cast<unsigned char>(name[at - 1]))))
        return swapped(at, sides);
  for (const Sides& sides : letters)
    for (size_t at = name.find(sides.from); at != std::string::npos; at = name.find(sides.from, at + 1))
      if (name.size() > 1 && (at == 0 || !is_letter(at - 1)) && !is_letter(at + 1)) return swapped(at, sides);
  return std::nullopt;
}

}  // namespace focal
