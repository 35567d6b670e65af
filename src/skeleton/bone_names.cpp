#include "skeleton/bone_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

namespace focal {
namespace {

// One bone in the spelling of each convention: VRM, Mixamo (without its prefix), Unreal mannequin, Rigify's
// deforming bones, 3ds Max Biped (without its prefix), Daz, CC and iClone, Quaternius, KayKit. %: the side.
// "": the convention has no such bone, or no name of its own for it.
struct Bone {
  const char *vrm, *mixamo, *unreal, *rigify, *biped, *daz, *cc, *quaternius, *kaykit;
};

constexpr Bone bones[] = {
    {"hips", "Hips", "pelvis", "DEF-spine", "Pelvis", "hip", "CC_Base_Hip", "Hips", "hips"},
    {"spine", "Spine", "spine_01", "DEF-spine.001", "Spine", "abdomenLower", "CC_Base_Waist", "Abdomen",
     "spine"},
    {"chest", "Spine1", "spine_02", "DEF-spine.002", "Spine1", "abdomenUpper", "CC_Base_Spine01", "Torso",
     "chest"},
    {"upperChest", "Spine2", "spine_03", "DEF-spine.003", "Spine2", "chestLower", "CC_Base_Spine02", "Chest",
     ""},
    {"neck", "Neck", "neck_01", "DEF-spine.004", "Neck", "neckLower", "CC_Base_NeckTwist01", "Neck", ""},
    {"head", "Head", "head", "DEF-spine.006", "Head", "head", "CC_Base_Head", "Head", "head"},
    {"jaw", "Jaw", "jaw", "DEF-jaw", "", "", "", "", ""},
    {"%Eye", "%Eye", "eye_%", "DEF-eye.%", "", "%Eye", "CC_Base_%_Eye", "", ""},
    {"%Shoulder", "%Shoulder", "clavicle_%", "DEF-shoulder.%", "% Clavicle", "%Collar", "CC_Base_%_Clavicle",
     "Shoulder.%", ""},
    {"%UpperArm", "%Arm", "upperarm_%", "DEF-upper_arm.%", "% UpperArm", "%ShldrBend", "CC_Base_%_Upperarm",
     "UpperArm.%", "upperarm.%"},
    {"%LowerArm", "%ForeArm", "lowerarm_%", "DEF-forearm.%", "% Forearm", "%ForearmBend", "CC_Base_%_Forearm",
     "LowerArm.%", "lowerarm.%"},
    {"%Hand", "%Hand", "hand_%", "DEF-hand.%", "% Hand", "%Hand", "CC_Base_%_Hand", "Wrist.%", "wrist.%"},
    {"%UpperLeg", "%UpLeg", "thigh_%", "DEF-thigh.%", "% Thigh", "%ThighBend", "CC_Base_%_Thigh",
     "UpperLeg.%", "upperleg.%"},
    {"%LowerLeg", "%Leg", "calf_%", "DEF-shin.%", "% Calf", "%Shin", "CC_Base_%_Calf", "LowerLeg.%",
     "lowerleg.%"},
    {"%Foot", "%Foot", "foot_%", "DEF-foot.%", "% Foot", "%Foot", "CC_Base_%_Foot", "Foot.%", "foot.%"},
    {"%Toes", "%ToeBase", "ball_%", "DEF-toe.%", "% Toe0", "%Toe", "CC_Base_%_ToeBase", "Toes.%", "toes.%"},
    {"%ThumbMetacarpal", "%HandThumb1", "thumb_01_%", "DEF-thumb.01.%", "% Finger0", "%Thumb1",
     "CC_Base_%_Thumb1", "Thumb1.%", ""},
    {"%ThumbProximal", "%HandThumb2", "thumb_02_%", "DEF-thumb.02.%", "% Finger01", "%Thumb2",
     "CC_Base_%_Thumb2", "Thumb2.%", ""},
    {"%ThumbDistal", "%HandThumb3", "thumb_03_%", "DEF-thumb.03.%", "% Finger02", "%Thumb3",
     "CC_Base_%_Thumb3", "Thumb3.%", ""},
    {"%IndexProximal", "%HandIndex1", "index_01_%", "DEF-f_index.01.%", "% Finger1", "%Index1",
     "CC_Base_%_Index1", "Index1.%", ""},
    {"%IndexIntermediate", "%HandIndex2", "index_02_%", "DEF-f_index.02.%", "% Finger11", "%Index2",
     "CC_Base_%_Index2", "Index2.%", ""},
    {"%IndexDistal", "%HandIndex3", "index_03_%", "DEF-f_index.03.%", "% Finger12", "%Index3",
     "CC_Base_%_Index3", "Index3.%", ""},
    {"%MiddleProximal", "%HandMiddle1", "middle_01_%", "DEF-f_middle.01.%", "% Finger2", "%Mid1",
     "CC_Base_%_Mid1", "Middle1.%", ""},
    {"%MiddleIntermediate", "%HandMiddle2", "middle_02_%", "DEF-f_middle.02.%", "% Finger21", "%Mid2",
     "CC_Base_%_Mid2", "Middle2.%", ""},
    {"%MiddleDistal", "%HandMiddle3", "middle_03_%", "DEF-f_middle.03.%", "% Finger22", "%Mid3",
     "CC_Base_%_Mid3", "Middle3.%", ""},
    {"%RingProximal", "%HandRing1", "ring_01_%", "DEF-f_ring.01.%", "% Finger3", "%Ring1", "CC_Base_%_Ring1",
     "Ring1.%", ""},
    {"%RingIntermediate", "%HandRing2", "ring_02_%", "DEF-f_ring.02.%", "% Finger31", "%Ring2",
     "CC_Base_%_Ring2", "Ring2.%", ""},
    {"%RingDistal", "%HandRing3", "ring_03_%", "DEF-f_ring.03.%", "% Finger32", "%Ring3", "CC_Base_%_Ring3",
     "Ring3.%", ""},
    {"%LittleProximal", "%HandPinky1", "pinky_01_%", "DEF-f_pinky.01.%", "% Finger4", "%Pinky1",
     "CC_Base_%_Pinky1", "Pinky1.%", ""},
    {"%LittleIntermediate", "%HandPinky2", "pinky_02_%", "DEF-f_pinky.02.%", "% Finger41", "%Pinky2",
     "CC_Base_%_Pinky2", "Pinky2.%", ""},
    {"%LittleDistal", "%HandPinky3", "pinky_03_%", "DEF-f_pinky.03.%", "% Finger42", "%Pinky3",
     "CC_Base_%_Pinky3", "Pinky3.%", ""},
};

constexpr std::string_view deforming = "DEF-";  // Rigify's bones; its metarig uses the same names without it

bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)); }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)); }
char small(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

std::string with_side(std::string name, const char* side) {
  if (const size_t at = name.find('%'); at != std::string::npos) name.replace(at, 1, side);
  return name;
}

// The bone in every convention that can be written; empty: it has no such bone.
using Names = std::map<BoneNames, std::string>;

Names names_of(const Bone& bone, bool left) {
  Names names;
  const std::string vrm = with_side(bone.vrm, left ? "left" : "right");
  names[BoneNames::vrm] = names[BoneNames::unity] = vrm;
  char& initial = names[BoneNames::unity][0];
  initial = static_cast<char>(std::toupper(static_cast<unsigned char>(initial)));
  names[BoneNames::mixamo] = "mixamorig:" + with_side(bone.mixamo, left ? "Left" : "Right");
  names[BoneNames::unreal] = with_side(bone.unreal, left ? "l" : "r");
  names[BoneNames::rigify] = with_side(bone.rigify, left ? "L" : "R");
  names[BoneNames::rigify_metarig] = names[BoneNames::rigify].substr(deforming.size());
  return names;
}

std::vector<Names> all_bones() {
  std::vector<Names> result;
  for (const Bone& bone : bones)
    for (const bool left : {true, false})
      if (left || *bone.vrm == '%') result.push_back(names_of(bone, left));
  return result;
}

bool is_called(const Names& names, const std::string& name) {
  for (const auto& [convention, own] : names)  // not the metarig's, whose `spine` are the hips
    if (convention != BoneNames::rigify_metarig && own == name) return true;
  return names.at(BoneNames::mixamo) == "mixamorig:" + name;  // the prefix is often dropped
}

// Viewers drop dots, exporters replace them by underscores.
std::string plain(const std::string& name) {
  std::string result;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c))) result += small(c);
  return result;
}

using Table = std::map<std::string, std::string>;  // normalised name in a convention -> VRM's

template <class Writer>
Table table_of(const Writer& written) {
  Table table;
  for (const Bone& bone : bones)
    for (const bool left : {true, false})
      if (const std::string name = written(bone, left); !name.empty())
        table.emplace(plain(name), with_side(bone.vrm, left ? "left" : "right"));
  return table;
}

std::vector<Table> all_tables() {
  std::vector<Table> tables;
  const auto add = [&](BoneNames convention) {
    tables.push_back(table_of([&](const Bone& bone, bool left) { return names_of(bone, left)[convention]; }));
  };
  add(BoneNames::rigify_metarig);
  for (const auto column : {&Bone::biped, &Bone::daz, &Bone::cc, &Bone::quaternius, &Bone::kaykit})
    tables.push_back(
        table_of([&](const Bone& bone, bool left) { return with_side(bone.*column, left ? "L" : "R"); }));
  add(BoneNames::vrm);
  tables.push_back(
      table_of([](const Bone& bone, bool left) { return with_side(bone.mixamo, left ? "Left" : "Right"); }));
  add(BoneNames::unreal), add(BoneNames::rigify);
  return tables;
}

using Words = std::vector<std::string>;

// Runs of letters, split at changes from lower to upper case, in lower case; a prefix before the last colon
// is dropped.
Words words_of(const std::string& name) {
  const std::string text = name.substr(name.rfind(':') == std::string::npos ? 0 : name.rfind(':') + 1);
  Words words;
  for (size_t i = 0; i < text.size(); ++i) {
    if (!is_letter(text[i])) continue;
    const bool starts =
        i == 0 || !is_letter(text[i - 1]) || (is_upper(text[i]) && !is_upper(text[i - 1])) ||
        (is_upper(text[i]) && i + 1 < text.size() && is_letter(text[i + 1]) && !is_upper(text[i + 1]));
    if (starts) words.emplace_back();
    words.back() += small(text[i]);
  }
  return words;
}

// Splits off a side at the start or the end of a word: leftarm, armleft.
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

// Words that mark a joint as a helper, a control, or not part of a humanoid's body.
const std::set<std::string>& foreign_words() {
  static const std::set<std::string> words = {
      "twist", "roll",   "ik",     "fk",    "pole", "target", "ctrl",   "control", "end",
      "tip",   "helper", "nub",    "prop",  "hair", "skirt",  "cape",   "cloth",   "tail",
      "wing",  "ear",    "weapon", "back",  "brow", "lid",    "pocket", "sleeve",  "breast",
      "cheek", "lip",    "tongue", "teeth", "heel", "socket", "share",  "bend",    "corrective"};
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

// Words without information on the role: the program that wrote the file, and generic words for bones.
const std::set<std::string>& empty_words() {
  static const std::set<std::string> words = {
      "mixamorig", "bip", "valvebiped", "def",      "org",       "bone", "joint",   "jnt",    "sk",
      "b",         "c",   "j",          "armature", "character", "rig",  "stretch", "finger", "f"};
  return words;
}

}  // namespace

std::optional<std::string> bone_name(const std::string& name, BoneNames convention) {
  if (convention == BoneNames::as_trained) return name;
  static const std::vector<Names> all = all_bones();
  for (const Names& names : all)
    if (is_called(names, name)) {
      const std::string& wanted = names.at(convention);
      return wanted.empty() ? std::nullopt : std::optional(wanted);
    }
  return std::nullopt;
}

std::vector<std::string> humanoid_names(const std::vector<std::string>& names,
                                        const std::vector<std::string>& bare) {
  static const std::vector<Table> tables = all_tables();
  const auto bone = [&](const Table& table, size_t i) {
    const auto found = table.find(plain(names[i]));
    return found == table.end() ? table.find(plain(bare[i])) : found;
  };
  const auto known_to = [&](const Table& table) {
    int64_t known = 0;
    for (size_t i = 0; i < names.size(); ++i) known += bone(table, i) != table.end();
    return known;
  };
  const auto best = std::max_element(tables.begin(), tables.end(), [&](const Table& a, const Table& b) {
    return known_to(a) < known_to(b);
  });
  std::vector<std::string> result(names.size());
  for (size_t i = 0; i < names.size(); ++i)
    if (const auto found = bone(*best, i); found != best->end()) result[i] = found->second;
  return result;
}

std::vector<std::string> bone_words(const std::string& name) {
  Words words = words_of(name);
  split_sides(words);
  return words;
}

BoneKind bone_kind(const std::string& name) {
  const Words words = bone_words(name);
  BoneKind kind;
  std::string rest;
  for (const std::string& word : words) {
    if (word == "front" || word == "hind" || word == "rear") kind.of_quadruped = true;
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
  if (found != kinds().end() && !kind.of_quadruped) kind.what = found->second;
  return kind;
}

std::optional<std::string> mirrored_name(const std::string& name) {
  struct Sides {
    std::string from, to;
  };
  static const std::vector<Sides> words = {{"left", "right"}, {"right", "left"}, {"Left", "Right"},
                                           {"Right", "Left"}, {"LEFT", "RIGHT"}, {"RIGHT", "LEFT"}};
  static const std::vector<Sides> letters = {{"L", "R"}, {"R", "L"}, {"l", "r"}, {"r", "l"}};
  const auto letter_at = [&](size_t at) { return at < name.size() && is_letter(name[at]); };
  const auto swapped = [&](size_t at, const Sides& sides) {
    return name.substr(0, at) + sides.to + name.substr(at + sides.from.size());
  };
  for (const Sides& sides : words)
    for (size_t at = name.find(sides.from); at != std::string::npos; at = name.find(sides.from, at + 1))
      // "bright" and "cleft" contain no side.
      if (at == 0 || !letter_at(at - 1) ||
          (std::isupper(static_cast<unsigned char>(name[at])) &&
           std::islower(static_cast<unsigned char>(name[at - 1]))))
        return swapped(at, sides);
  for (const Sides& sides : letters)
    for (size_t at = name.find(sides.from); at != std::string::npos; at = name.find(sides.from, at + 1))
      if (name.size() > 1 && (at == 0 || !letter_at(at - 1)) && !letter_at(at + 1)) return swapped(at, sides);
  return std::nullopt;
}

}  // namespace focal
