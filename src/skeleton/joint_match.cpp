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

// Prefixes that exporters write; the root joint may have the prefix as its name, or lack it.
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

// Length of several prefixes: "Armature_mixamorig:".
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

// Length of the prefix of each name to ignore.
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
  if (is_humanoid) {
    const Names known = humanoid_names(names, result);
    for (size_t i = 0; i < names.size(); ++i)
      if (!known[i].empty()) result[i] = known[i];
  }
  return std::set<std::string>(result.begin(), result.end()).size() == names.size() ? result : names;
}

namespace {

constexpr std::array spellings{Spelling::as_written, Spelling::without_prefix, Spelling::without_any_prefix,
                               Spelling::humanoid};

// Matches remaining names by one spelling. Returns the number of new matches.
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
  // "spine" means the hips in one program and the spine in another: the spelling with most matches comes
  // first.
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

std::string quoted(const std::vector<std::string>& names, size_t most) {
  std::string text;
  for (size_t i = 0; i < std::min(names.size(), most); ++i) text += (i ? ", '" : "'") + names[i] + "'";
  return text;
}

}  // namespace focal
