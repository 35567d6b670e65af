// Joints of different files find each other by their names: as written, without a prefix, as bones of a humanoid.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace focal {

enum class Spelling { as_written, without_prefix, without_any_prefix, humanoid };

// The names of one file as they are compared. A file in which two joints would get one name keeps its own. humanoid: without prefixes,
// and what a convention of bone_names.h knows by its VRM name.
std::vector<std::string> spelled(const std::vector<std::string>& names, Spelling spelling);

struct JointMatch {
  std::vector<int32_t> there;       // per wanted name its place in the other list, or -1
  std::vector<char> by_convention;  // per wanted name: only as a bone of a humanoid, whose axes may be others
  std::vector<std::string> missing;
};

// By the spelling that finds most wanted names, the plainest of equal ones; then, what is missing, by the others in order. No name is
// found twice.
JointMatch match_joints(const std::vector<std::string>& wanted, const std::vector<std::string>& names);

// "'a', 'b', 'c'": the first of them, for messages.
std::string quoted(const std::vector<std::string>& names, size_t most);

}  // namespace focal
