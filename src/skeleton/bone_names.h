// What the bones of a humanoid are called elsewhere.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace focal {

enum class BoneNames : int32_t {
  as_trained = 0,
  vrm = 1,
  mixamo = 2,
  unreal = 3,
  rigify = 4,
  unity = 5,
  rigify_metarig = 6
};

// The name of the same bone in another convention; nothing for one that no convention knows (a tail, a skirt). Any of the
// conventions is understood, but for the metarig's, whose `spine` are the hips. VRM: VRM 1.0's humanoid bones; Unity, whose names Godot shares: HumanBodyBones.
std::optional<std::string> bone_name(const std::string& name, BoneNames convention);

// The name of the same thing on the other side: left and right, or a single L and R set apart (hand.L, L_hand, hand_l), whatever
// the case. Nothing for a name without a side.
std::optional<std::string> mirrored_name(const std::string& name);

}  // namespace focal
