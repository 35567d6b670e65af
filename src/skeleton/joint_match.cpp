#include "skeleton/joint_match.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

#include "skeleton/bone_names.h"

namespace focal {
namespace {

using Names = std::vector<std::string>;

// Prefixes that exporters write; the root joint may be called so itself, or lack it.
size_t known_prefix(const std::string& name) {
  const auto after_digits = [&](size_t at) {
    while (at < name.size() && std::isdigit(static_cast<unsigned char>(name[at]))) ++at;
    return at;
  };
  if (name.starts_with("mixamorig"))
    if (const size_t at = after_digits(9); at < name.size() && (name[at] == ':' || name[at] == '_'))
      return at + 1;
  if (name.starts_with("Armature") && name.size() > 9 && (name[8] == '_' || name[8] == '|')) return 9;
  if (name.starts_with("Bip"))
    if (const size_t at = after_digits(3);
        at > 3 && at + 1 < name.size() && (name[at] == ' ' || name[at] == '_'))
      return at + 1;
  return 0;
}

// All of them: "Armature_mixamorig:".
size_t known_prefixes(const std::string& name) {
  size_t all = 0;
  while (const size_t one = known_prefix(name.substr(all))) all += one;
  return all;
}

size_t shared_prefix(const Names& names) {
  size_t length = names.empty() ? 0 : names[0].size();
  for (const std::string& name : names) {
    const auto [at, other] = std::mismatch(name.begin(), name.end(), names[0].begin(), names[0].end());
    length = std::min(length, static_cast<size_t>(at - name.begin()));
    length = std::min(length, name.empty() ? 0 : name.size() - 1);  // something must be left
  }
  return names.size() > 1 ? length : 0;
}

// How long the prefix of each name is that does not count.
std::vector<size_t> prefixes(const Names& names, Spelling spelling) {
  std::vector<size_t> result(names.size(), 0);
  if (spelling == Spelling::as_written) return result;
  std::transform(names.begin(), names.end(), result.begin(), known_prefixes);
  if (std::any_of(result.begin(), result.end(), [](size_t length) { return length > 0; })) return result;
  size_t length = shared_prefix(names);
  const auto separates = [&](size_t at) {
    return std::string_view(":|_. -").find(names[0][at]) != std::string::npos;
  };
  if (spelling == Spelling::without_prefix)
    while (length > 0 && !separates(length - 1)) --length;
  std::fill(result.begin(), result.end(), length);
  return result;
}

// A bone as VRM calls it, and where names differ from what bone_name knows. %: the side, as each writes it.
struct Bone {
  const char *vrm, *meta, *biped, *daz, *cc, *quaternius, *kaykit;
};

constexpr std::array bones{
    Bone{"hips", "spine", "Pelvis", "hip", "CC_Base_Hip", "Hips", "hips"},
    Bone{"spine", "spine.001", "Spine", "abdomenLower", "CC_Base_Waist", "Abdomen", "spine"},
    Bone{"chest", "spine.002", "Spine1", "abdomenUpper", "CC_Base_Spine01", "Torso", "chest"},
    Bone{"upperChest", "spine.003", "Spine2", "chestLower", "CC_Base_Spine02", "Chest", ""},
    Bone{"neck", "spine.004", "Neck", "neckLower", "CC_Base_NeckTwist01", "Neck", ""},
    Bone{"head", "spine.006", "Head", "head", "CC_Base_Head", "Head", "head"},
    Bone{"%Eye", "eye.%", "", "%Eye", "CC_Base_%_Eye", "", ""},
    Bone{"%Shoulder", "shoulder.%", "% Clavicle", "%Collar", "CC_Base_%_Clavicle", "Shoulder.%", ""},
    Bone{"%UpperArm", "upper_arm.%", "% UpperArm", "%ShldrBend", "CC_Base_%_Upperarm", "UpperArm.%",
         "upperarm.%"},
    Bone{"%LowerArm", "forearm.%", "% Forearm", "%ForearmBend", "CC_Base_%_Forearm", "LowerArm.%",
         "lowerarm.%"},
    Bone{"%Hand", "hand.%", "% Hand", "%Hand", "CC_Base_%_Hand", "Wrist.%", "wrist.%"},
    Bone{"%UpperLeg", "thigh.%", "% Thigh", "%ThighBend", "CC_Base_%_Thigh", "UpperLeg.%", "upperleg.%"},
    Bone{"%LowerLeg", "shin.%", "% Calf", "%Shin", "CC_Base_%_Calf", "LowerLeg.%", "lowerleg.%"},
    Bone{"%Foot", "foot.%", "% Foot", "%Foot", "CC_Base_%_Foot", "Foot.%", "foot.%"},
    Bone{"%Toes", "toe.%", "% Toe0", "%Toe", "CC_Base_%_ToeBase", "Toes.%", "toes.%"},
    Bone{"%ThumbMetacarpal", "thumb.01.%", "% Finger0", "%Thumb1", "CC_Base_%_Thumb1", "Thumb1.%", ""},
    Bone{"%ThumbProximal", "thumb.02.%", "% Finger01", "%Thumb2", "CC_Base_%_Thumb2", "Thumb2.%", ""},
    Bone{"%ThumbDistal", "thumb.03.%", "% Finger02", "%Thumb3", "CC_Base_%_Thumb3", "Thumb3.%", ""},
    Bone{"%IndexProximal", "f_index.01.%", "% Finger1", "%Index1", "CC_Base_%_Index1", "Index1.%", ""},
    Bone{"%IndexIntermediate", "f_index.02.%", "% Finger11", "%Index2", "CC_Base_%_Index2", "Index2.%", ""},
    Bone{"%IndexDistal", "f_index.03.%", "% Finger12", "%Index3", "CC_Base_%_Index3", "Index3.%", ""},
    Bone{"%MiddleProximal", "f_middle.01.%", "% Finger2", "%Mid1", "CC_Base_%_Mid1", "Middle1.%", ""},
    Bone{"%MiddleIntermediate", "f_middle.02.%", "% Finger21", "%Mid2", "CC_Base_%_Mid2", "Middle2.%", ""},
    Bone{"%MiddleDistal", "f_middle.03.%", "% Finger22", "%Mid3", "CC_Base_%_Mid3", "Middle3.%", ""},
    Bone{"%RingProximal", "f_ring.01.%", "% Finger3", "%Ring1", "CC_Base_%_Ring1", "Ring1.%", ""},
    Bone{"%RingIntermediate", "f_ring.02.%", "% Finger31", "%Ring2", "CC_Base_%_Ring2", "Ring2.%", ""},
    Bone{"%RingDistal", "f_ring.03.%", "% Finger32", "%Ring3", "CC_Base_%_Ring3", "Ring3.%", ""},
    Bone{"%LittleProximal", "f_pinky.01.%", "% Finger4", "%Pinky1", "CC_Base_%_Pinky1", "Pinky1.%", ""},
    Bone{"%LittleIntermediate", "f_pinky.02.%", "% Finger41", "%Pinky2", "CC_Base_%_Pinky2", "Pinky2.%", ""},
    Bone{"%LittleDistal", "f_pinky.03.%", "% Finger42", "%Pinky3", "CC_Base_%_Pinky3", "Pinky3.%", ""},
};
constexpr std::array columns{&Bone::meta, &Bone::biped,      &Bone::daz,
                             &Bone::cc,   &Bone::quaternius, &Bone::kaykit};

std::string sided(std::string name, const char* side) {
  if (const size_t at = name.find('%'); at != std::string::npos) name.replace(at, 1, side);
  return name;
}

// Viewers drop dots, exporters write them as underscores.
std::string plain(const std::string& name) {
  std::string result;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

using Table = std::map<std::string, std::string>;  // a plain name -> VRM's

std::vector<Table> all_tables() {
  std::vector<Table> tables;
  for (const auto column : columns) {
    Table& table = tables.emplace_back();
    for (const Bone& bone : bones)
      for (const auto& [side, letter] : {std::pair{"left", "L"}, {"right", "R"}})
        if (*(bone.*column)) table.emplace(plain(sided(bone.*column, letter)), sided(bone.vrm, side));
  }
  for (const BoneNames known : {BoneNames::vrm, BoneNames::mixamo, BoneNames::unreal, BoneNames::rigify}) {
    Table& table = tables.emplace_back();
    for (const Bone& bone : bones)
      for (const char* side : {"left", "right"})
        if (auto name = bone_name(sided(bone.vrm, side), known))
          table.emplace(plain(name->substr(known_prefixes(*name))), sided(bone.vrm, side));
  }
  return tables;
}

// What a convention calls by its VRM name, with its prefix or without.
Names as_humanoid(const Names& names, Names bare) {
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
  Names result = bare;
  for (size_t i = 0; i < names.size(); ++i)
    if (const auto found = bone(*best, i); found != best->end()) result[i] = found->second;
  return result;
}

Names without(const Names& names, Spelling spelling) {
  const std::vector<size_t> prefix = prefixes(names, spelling);
  Names result;
  for (size_t i = 0; i < names.size(); ++i) result.push_back(names[i].substr(prefix[i]));
  return result;
}

}  // namespace

std::vector<std::string> spelled(const std::vector<std::string>& names, Spelling spelling) {
  const bool is_humanoid = spelling == Spelling::humanoid;
  Names result = without(names, is_humanoid ? Spelling::without_prefix : spelling);
  if (is_humanoid) result = as_humanoid(names, std::move(result));
  return std::set<std::string>(result.begin(), result.end()).size() == names.size() ? result : names;
}

namespace {

constexpr std::array spellings{Spelling::as_written, Spelling::without_prefix, Spelling::without_any_prefix,
                               Spelling::humanoid};

// Finds what is still missing by one spelling. Returns how many it found.
int32_t find_more(const Names& wanted, const Names& names, Spelling spelling, std::vector<char>& taken,
                  JointMatch& match) {
  std::map<std::string, size_t> places;
  const Names theirs = spelled(names, spelling), ours = spelled(wanted, spelling);
  for (size_t i = 0; i < theirs.size(); ++i)
    if (!taken[i]) places.emplace(theirs[i], i);
  int32_t count = 0;
  for (size_t w = 0; w < ours.size(); ++w) {
    const auto found = places.find(ours[w]);
    if (match.there[w] >= 0 || found == places.end() || taken[found->second]) continue;
    taken[found->second] = 1, ++count;
    match.there[w] = static_cast<int32_t>(found->second);
    match.by_convention[w] = spelling == Spelling::humanoid;
  }
  return count;
}

}  // namespace

JointMatch match_joints(const std::vector<std::string>& wanted, const std::vector<std::string>& names) {
  const JointMatch none{std::vector<int32_t>(wanted.size(), -1), std::vector<char>(wanted.size(), 0), {}};
  // A "spine" is the hips of one program and the spine of another: the spelling that finds most comes first.
  Spelling first = Spelling::as_written;
  int32_t most = 0;
  for (const Spelling spelling : spellings) {
    JointMatch trial = none;
    std::vector<char> taken(names.size(), 0);
    if (const int32_t count = find_more(wanted, names, spelling, taken, trial); count > most)
      most = count, first = spelling;
  }
  JointMatch match = none;
  std::vector<char> taken(names.size(), 0);
  find_more(wanted, names, first, taken, match);
  for (const Spelling spelling : spellings) find_more(wanted, names, spelling, taken, match);
  for (size_t w = 0; w < wanted.size(); ++w)
    if (match.there[w] < 0) match.missing.push_back(wanted[w]);
  return match;
}

}  // namespace focal
