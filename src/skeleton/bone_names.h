// What the bones of a humanoid are called elsewhere.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace focal {

enum class BoneNames : int32_t { as_trained = 0, vrm = 1, mixamo = 2, unreal = 3, rigify = 4, unity = 5 };

// The name of the same bone in another convention; nothing for one that no convention knows (a tail, a skirt). Any of the
// conventions is understood. VRM: VRM 1.0's humanoid bones; Unity, whose names Godot shares: HumanBodyBones.
std::optional<std::string> bone_name(const std::string& name, BoneNames convention);

// Every name in the convention; those without one keep theirs and are named in `unknown`.
std::vector<std::string> bone_names(const std::vector<std::string>& names, BoneNames convention,
                                    std::vector<std::string>& unknown);

// The name of the same thing on the other side: left and right, or a single L and R set apart (hand.L, L_hand, hand_l), whatever
// the case. Nothing for a name without a side.
std::optional<std::string> mirrored_name(const std::string& name);

}  // namespace focal
