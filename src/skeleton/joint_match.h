// Matches joints of different files by their names: as written, without a prefix, or as bones of a humanoid.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace focal {

enum class Spelling { as_written, without_prefix, without_any_prefix, humanoid };

// The names of one file in the form used for comparison. If two joints of a file would get the same name, the
// file keeps its own names. humanoid: without prefixes, and with the VRM name of bones that a convention of
// bone_names.h contains.
std::vector<std::string> spelled(const std::vector<std::string>& names, Spelling spelling);

struct JointMatch {
  std::vector<int32_t> there;  // per wanted name its index in the other list, or -1
  // Per wanted name: matched only as a bone of a humanoid, whose axes may differ.
  std::vector<char> by_convention;
  std::vector<std::string> missing;
};

// Matches by the spelling with most matches, the plainest of equal ones; then the missing names by the others
// in order. No name is matched twice.
JointMatch match_joints(const std::vector<std::string>& wanted, const std::vector<std::string>& names);

// "'a', 'b', 'c'": the first of them, for messages.
std::string quoted(const std::vector<std::string>& names, size_t most);

}  // namespace focal
