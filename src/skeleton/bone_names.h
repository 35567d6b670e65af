// Names of the bones of a humanoid: the only code that maps spellings to bones.
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

// The name of the same bone in another convention; empty for one that no convention has (a tail, a skirt).
// Accepts names of any of the conventions except the metarig's, whose `spine` are the hips. VRM: VRM 1.0's
// humanoid bones; Unity (and Godot): HumanBodyBones.
std::optional<std::string> bone_name(const std::string& name, BoneNames convention);

// For each name VRM's name of that bone; empty: unknown. Uses the convention that matches most of the names,
// one of those above, Rigify's metarig, 3ds Max Biped, Daz, CC and iClone, Quaternius or KayKit; dots,
// blanks, underscores and case are ignored. bare: the same names without prefixes, used where the whole name
// does not match.
std::vector<std::string> humanoid_names(const std::vector<std::string>& names,
                                        const std::vector<std::string>& bare);

// The meaning of the words of a name, in any convention: Bip001 L UpperArm, thigh.l, RightForeArm.
struct BoneKind {
  // VRM's name without a side (UpperArm, Hand), hips, spine, neck, head, jaw, or a finger (Thumb, Index,
  // ...); arm, leg, shoulder: one of two bones, depending on the hierarchy. Empty: not a known bone, or a
  // helper (twist, ik).
  std::string what;
  char side = 0;              // 'l', 'r' or none
  bool of_quadruped = false;  // contains "front" or "hind"
};
BoneKind bone_kind(const std::string& name);
// Lower-case words, split at non-letters and capitals; sides are words of their own.
std::vector<std::string> bone_words(const std::string& name);

// The name of the counterpart on the other side: left and right, or a separate L and R (hand.L, L_hand,
// hand_l), case-insensitive. Empty for a name without a side.
std::optional<std::string> mirrored_name(const std::string& name);

}  // namespace focal
