#include "skeleton/bone_roles.h"

#include <algorithm>
#include <optional>
#include <set>

#include "skeleton/joint_match.h"

namespace focal {
namespace {

class Roles {
 public:
  explicit Roles(const std::vector<Joint>& joints) : joints_(joints), role_(joints.size()) {
    std::vector<std::string> names;
    for (const Joint& joint : joints) names.push_back(joint.name), kind_.push_back(bone_kind(joint.name));
    in_convention_ = humanoid_names(names, spelled(names, Spelling::without_prefix));
  }

  std::vector<std::string> find() {
    const bool at_its_word = has_hidden_hips();
    // Daz has both a hip and a pelvis.
    take_convention([&](const BoneKind& kind) { return at_its_word || is_hips(kind); });
    take_known_names();
    take_convention([](const BoneKind& kind) { return kind.what.empty(); });
    for (size_t j = 0; j < joints_.size(); ++j) settle_limb(j);
    take_plain("hips"), take_plain("head"), take_plain("neck"), take_plain("jaw");
    settle_spine();
    for (const char* finger : {"Thumb", "Index", "Middle", "Ring", "Little"})
      for (const char side : {'l', 'r'}) settle_finger(finger, side);
    if (!taken_.contains("hips") || !taken_.contains("head") ||
        !(taken_.contains("leftUpperLeg") || taken_.contains("leftUpperArm")))
      role_.assign(role_.size(), "");
    return role_;
  }

 private:
  static bool is_hips(const BoneKind& kind) { return kind.what == "hips" && kind.side == 0; }

  static std::string sided(char side, const std::string& what) {
    return (side == 'l' ? "left" : "right") + what;
  }

  bool give(size_t joint, const std::string& role) {
    if (!role_[joint].empty() || !taken_.insert(role).second) return false;
    role_[joint] = role;
    return true;
  }

  // Whether the hips have a name that only the convention of all names explains: Rigify's metarig calls them
  // `spine`. A convention has no names for the legs of an animal.
  bool has_hidden_hips() const {
    for (const BoneKind& kind : kind_)
      if (is_hips(kind) || kind.of_quadruped) return false;
    return std::find(in_convention_.begin(), in_convention_.end(), "hips") != in_convention_.end();
  }

  template <class Wanted>
  void take_convention(const Wanted& wanted) {
    for (size_t j = 0; j < joints_.size(); ++j)
      if (!in_convention_[j].empty() && wanted(kind_[j])) give(j, in_convention_[j]);
  }

  // Except for names that mean another bone in other skeletons: LeftLeg, LeftArm, Shoulder.
  void take_known_names() {
    static const std::set<std::string> ambiguous = {"arm", "leg", "shoulder"};
    for (size_t j = 0; j < joints_.size(); ++j)
      if (ambiguous.contains(kind_[j].what))
        continue;
      else if (const auto known = bone_name(joints_[j].name, BoneNames::vrm))
        give(j, *known);
  }

  void take_plain(const std::string& what) {
    for (size_t j = 0; j < joints_.size(); ++j)
      if (kind_[j].what == what && kind_[j].side == 0) give(j, what);
  }

  // Whether a descendant on the same side is one of these.
  bool has_below(size_t joint, const std::set<std::string>& whats) const {
    for (size_t j = joint + 1; j < joints_.size(); ++j)
      if (kind_[j].side == kind_[joint].side && whats.contains(kind_[j].what) && is_above(joint, j))
        return true;
    return false;
  }
  bool is_above(size_t upper, size_t lower) const {
    int32_t p = joints_[lower].parent;
    while (p > static_cast<int32_t>(upper)) p = joints_[static_cast<size_t>(p)].parent;
    return p == static_cast<int32_t>(upper);
  }
  bool has_above(size_t joint, const std::string& role) const {
    for (int32_t p = joints_[joint].parent; p >= 0; p = joints_[static_cast<size_t>(p)].parent)
      if (role_[static_cast<size_t>(p)] == role) return true;
    return false;
  }

  // "arm" and "leg" are the upper or the lower bone, depending on the parent; "shoulder" is the upper arm if
  // there is no other.
  void settle_limb(size_t j) {
    BoneKind& kind = kind_[j];
    if (kind.side == 0) return;
    if (kind.what == "arm") kind.what = has_above(j, sided(kind.side, "UpperArm")) ? "LowerArm" : "UpperArm";
    if (kind.what == "leg") kind.what = has_above(j, sided(kind.side, "UpperLeg")) ? "LowerLeg" : "UpperLeg";
    if (kind.what == "hips") kind.what = has_below(j, {"UpperLeg"}) ? "" : "UpperLeg";  // the hip of a side
    if (kind.what == "shoulder") kind.what = has_below(j, {"arm", "UpperArm"}) ? "Shoulder" : "UpperArm";
    static const std::set<std::string> limbs = {"Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg",
                                                "LowerLeg", "Foot",     "Toes",     "Eye"};
    if (limbs.contains(kind.what)) give(j, sided(kind.side, kind.what));
  }

  // The joints between the hips and the neck, or the head if there is no neck, from bottom to top.
  void settle_spine() {
    std::vector<size_t> chain;
    const auto top = std::find_if(role_.begin(), role_.end(), [](const auto& r) { return r == "neck"; });
    const auto head = std::find_if(role_.begin(), role_.end(), [](const auto& r) { return r == "head"; });
    if (head == role_.end()) return;
    const auto from = static_cast<size_t>((top != role_.end() ? top : head) - role_.begin());
    for (int32_t p = joints_[from].parent; p >= 0 && role_[static_cast<size_t>(p)] != "hips";
         p = joints_[static_cast<size_t>(p)].parent)
      if (kind_[static_cast<size_t>(p)].what == "spine") chain.insert(chain.begin(), static_cast<size_t>(p));
    for (const char* role : {"spine", "chest", "upperChest"}) {
      while (!chain.empty() && !role_[chain.front()].empty()) chain.erase(chain.begin());
      if (chain.empty() || taken_.contains(role)) continue;
      give(chain.front(), role);
    }
  }

  // In the order of the hierarchy; a thumb has a metacarpal, the others start with the proximal bone.
  void settle_finger(const std::string& finger, char side) {
    const std::vector<std::string> bones =
        finger == "Thumb" ? std::vector<std::string>{"Metacarpal", "Proximal", "Distal"}
                          : std::vector<std::string>{"Proximal", "Intermediate", "Distal"};
    size_t next = 0;
    for (size_t j = 0; j < joints_.size() && next < bones.size(); ++j)
      if (kind_[j].what == finger && kind_[j].side == side && role_[j].empty())
        give(j, sided(side, finger + bones[next])), ++next;
  }

  const std::vector<Joint>& joints_;
  std::vector<BoneKind> kind_;
  std::vector<std::string> in_convention_, role_;
  std::set<std::string> taken_;
};

}  // namespace

std::vector<std::string> bone_roles(const std::vector<Joint>& joints) { return Roles(joints).find(); }

std::vector<std::string> names_by_role(const std::vector<Joint>& joints, BoneNames convention,
                                       size_t& known) {
  const bool keeps_own = convention == BoneNames::as_trained;
  const auto roles = keeps_own ? std::vector<std::string>(joints.size()) : bone_roles(joints);
  std::vector<std::string> names;
  known = 0;
  for (size_t j = 0; j < joints.size(); ++j) {
    const auto renamed = bone_name(roles[j].empty() ? joints[j].name : roles[j], convention);
    // A second joint of the same role keeps its name: roles are unique.
    const bool is_new = renamed && std::find(names.begin(), names.end(), *renamed) == names.end();
    known += is_new;
    names.push_back(is_new ? *renamed : joints[j].name);
  }
  return names;
}

}  // namespace focal
