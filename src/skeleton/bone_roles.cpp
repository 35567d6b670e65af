#include "skeleton/bone_roles.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>

#include "skeleton/bone_names.h"

namespace focal {
namespace {

using Words = std::vector<std::string>;

bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)); }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)); }

// Runs of letters, cut where a small letter meets a capital, in small letters; a prefix before the last colon is left out.
Words words_of(const std::string& name) {
  const std::string text = name.substr(name.rfind(':') == std::string::npos ? 0 : name.rfind(':') + 1);
  Words words;
  for (size_t i = 0; i < text.size(); ++i) {
    if (!is_letter(text[i])) continue;
    const bool starts =
        i == 0 || !is_letter(text[i - 1]) || (is_upper(text[i]) && !is_upper(text[i - 1])) ||
        (is_upper(text[i]) && i + 1 < text.size() && is_letter(text[i + 1]) && !is_upper(text[i + 1]));
    if (starts) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(text[i])));
  }
  return words;
}

// A side at the head or the end of a word that is written as one: leftarm, armleft.
void split_sides(Words& words) {
  Words result;
  for (const std::string& word : words) {
    bool found = false;
    for (const std::string side : {"left", "right"}) {
      if (found || word.size() <= side.size()) continue;
      if (word.starts_with(side))
        result.insert(result.end(), {side, word.substr(side.size())}), found = true;
      else if (word.ends_with(side))
        result.insert(result.end(), {word.substr(0, word.size() - side.size()), side}), found = true;
    }
    if (!found) result.push_back(word);
  }
  words = std::move(result);
}

// The kind of a joint: a word for what it is, without its side.
struct Kind {
  std::string what;  // empty: none that is known
  char side = 0;     // 'l', 'r' or none
};

// One of these, and the joint is a helper, a control, or of something else than a humanoid's body.
const std::set<std::string>& foreign_words() {
  static const std::set<std::string> words = {
      "twist",  "roll",  "ik",     "fk",    "pole",  "target", "ctrl",  "control", "end",       "tip",
      "helper", "nub",   "prop",   "hair",  "skirt", "cape",   "cloth", "tail",    "wing",      "ear",
      "weapon", "front", "hind",   "rear",  "back",  "brow",   "lid",   "pocket",  "sleeve",    "breast",
      "cheek",  "lip",   "tongue", "teeth", "heel",  "socket", "share", "bend",    "corrective"};
  return words;
}

const std::map<std::string, std::string>& kinds() {
  static const std::map<std::string, std::string> all = {
      {"hips", "hips"},         {"hip", "hips"},          {"pelvis", "hips"},       {"spine", "spine"},
      {"chest", "spine"},       {"upperchest", "spine"},  {"torso", "spine"},       {"abdomen", "spine"},
      {"waist", "spine"},       {"ribcage", "spine"},     {"neck", "neck"},         {"head", "head"},
      {"jaw", "jaw"},           {"eye", "Eye"},           {"shoulder", "shoulder"}, {"clavicle", "Shoulder"},
      {"collar", "Shoulder"},   {"upperarm", "UpperArm"}, {"uparm", "UpperArm"},    {"arm", "arm"},
      {"lowerarm", "LowerArm"}, {"forearm", "LowerArm"},  {"elbow", "LowerArm"},    {"hand", "Hand"},
      {"wrist", "Hand"},        {"upperleg", "UpperLeg"}, {"upleg", "UpperLeg"},    {"thigh", "UpperLeg"},
      {"leg", "leg"},           {"lowerleg", "LowerLeg"}, {"calf", "LowerLeg"},     {"shin", "LowerLeg"},
      {"knee", "LowerLeg"},     {"foot", "Foot"},         {"ankle", "Foot"},        {"toe", "Toes"},
      {"toes", "Toes"},         {"toebase", "Toes"},      {"ball", "Toes"},         {"thumb", "Thumb"},
      {"index", "Index"},       {"middle", "Middle"},     {"ring", "Ring"},         {"pinky", "Little"},
      {"little", "Little"},     {"armupper", "UpperArm"}, {"armlower", "LowerArm"}, {"legupper", "UpperLeg"},
      {"leglower", "LowerLeg"}};
  return all;
}

// Words that say nothing of the role: who wrote the file, and what every bone is.
const std::set<std::string>& empty_words() {
  static const std::set<std::string> words = {
      "mixamorig", "bip", "valvebiped", "def",      "org",       "bone", "joint",   "jnt",    "sk",
      "b",         "c",   "j",          "armature", "character", "rig",  "stretch", "finger", "f"};
  return words;
}

Kind kind_of(const std::string& name) {
  Words words = words_of(name);
  split_sides(words);
  Kind kind;
  std::string rest;
  for (const std::string& word : words) {
    if (foreign_words().contains(word)) return {};
    if (word == "l" || word == "left")
      kind.side = 'l';
    else if (word == "r" || word == "right")
      kind.side = 'r';
    else if (word.size() > 1 && !empty_words().contains(word))
      rest += word;
  }
  if (rest.starts_with("hand") && rest.size() > 4) rest.erase(0, 4);  // LeftHandIndex1
  const auto found = kinds().find(rest);
  if (found != kinds().end()) kind.what = found->second;
  return kind;
}

class Roles {
 public:
  explicit Roles(const std::vector<Joint>& joints) : joints_(joints), role_(joints.size()) {
    for (const Joint& joint : joints) kind_.push_back(kind_of(joint.name));
  }

  std::vector<std::string> find() {
    take_known_names();
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
  static std::string sided(char side, const std::string& what) {
    return (side == 'l' ? "left" : "right") + what;
  }

  bool give(size_t joint, const std::string& role) {
    if (!role_[joint].empty() || !taken_.insert(role).second) return false;
    role_[joint] = role;
    return true;
  }

  // But for those that mean another bone in other skeletons: LeftLeg, LeftArm, Shoulder.
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

  // Whether a joint below, on the same side, is one of these.
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

  // "arm" and "leg" are the upper or the lower bone, by what hangs above; "shoulder" is the upper arm where there is no other.
  void settle_limb(size_t j) {
    Kind& kind = kind_[j];
    if (kind.side == 0) return;
    if (kind.what == "arm") kind.what = has_above(j, sided(kind.side, "UpperArm")) ? "LowerArm" : "UpperArm";
    if (kind.what == "leg") kind.what = has_above(j, sided(kind.side, "UpperLeg")) ? "LowerLeg" : "UpperLeg";
    if (kind.what == "hips") kind.what = has_below(j, {"UpperLeg"}) ? "" : "UpperLeg";  // the hip of a side
    if (kind.what == "shoulder") kind.what = has_below(j, {"arm", "UpperArm"}) ? "Shoulder" : "UpperArm";
    static const std::set<std::string> limbs = {"Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg",
                                                "LowerLeg", "Foot",     "Toes",     "Eye"};
    if (limbs.contains(kind.what)) give(j, sided(kind.side, kind.what));
  }

  // The joints between the hips and the neck, or the head where there is no neck, from below.
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

  // In the order in which they hang; a thumb has a metacarpal, the others begin with the proximal bone.
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
  std::vector<Kind> kind_;
  std::vector<std::string> role_;
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
    // A second joint of the same role keeps its name: no two may have one.
    const bool is_new = renamed && std::find(names.begin(), names.end(), *renamed) == names.end();
    known += is_new;
    names.push_back(is_new ? *renamed : joints[j].name);
  }
  return names;
}

}  // namespace focal
