// What the bones of a humanoid are called: the one place that knows which spelling means which bone.
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

// Per name VRM's name of that bone; empty: not known. By the convention that knows most of the names, be it one of those above, Rigify's
// metarig, 3ds Max Biped, Daz, CC and iClone, Quaternius or KayKit; dots, blanks, underscores and case do not count. bare: the same names
// without prefixes, which are looked for where the whole name is none.
std::vector<std::string> humanoid_names(const std::vector<std::string>& names,
                                        const std::vector<std::string>& bare);

// What the words of a name say, whatever the convention: Bip001 L UpperArm, thigh.l, RightForeArm.
struct BoneKind {
  // VRM's name without a side (UpperArm, Hand), hips, spine, neck, head, jaw, or a finger (Thumb, Index, ...); arm, leg, shoulder: one of
  // two bones, by where it hangs. Empty: no bone that is known, or a helper (twist, ik).
  std::string what;
  char side = 0;              // 'l', 'r' or none
  bool of_quadruped = false;  // it says front or hind
};
BoneKind bone_kind(const std::string& name);
// Small letters, set apart by whatever is none and by capitals; sides are words of their own.
std::vector<std::string> bone_words(const std::string& name);

// The name of the same thing on the other side: left and right, or a single L and R set apart (hand.L, L_hand, hand_l), whatever
// the case. Nothing for a name without a side.
std::optional<std::string> mirrored_name(const std::string& name);

}  // namespace focal
