#include "skeleton/helper_bones.h"

#include <algorithm>

#include "skeleton/bone_names.h"

namespace focal {
namespace {

template <class T>
void keep(const std::vector<size_t>& kept, std::vector<T>& all) {
  if (all.empty()) return;
  std::vector<T> left;
  for (const size_t j : kept) left.push_back(std::move(all[j]));
  all = std::move(left);
}

void move_to(const std::vector<int32_t>& heir, Rig& rig) {
  const size_t most = rig.more.empty() ? max_influences : 2 * max_influences;
  for (size_t v = 0; v < rig.influences.size(); ++v) {
    std::vector<Influence> all = influences_of(rig, v);
    if (all.empty()) continue;
    for (Influence& one : all) one.joint = heir[one.joint];
    put_influences(heaviest(all, most), v, rig);
  }
}

}  // namespace

bool is_helper_bone(const std::string& name) {
  const std::vector<std::string> words = bone_words(name);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word == "twist" || word == "roll" || word == "helper" || word == "corrective" || word == "share";
  });
}

std::vector<size_t> drop_helper_bones(CharacterRig& character) {
  auto& joints = character.rig.joints;
  std::vector<size_t> kept;
  std::vector<int32_t> heir(joints.size());  // number among the remaining joints
  for (size_t j = 0; j < joints.size(); ++j) {
    const int32_t above = joints[j].parent < 0 ? -1 : heir[joints[j].parent];
    const bool goes = above >= 0 && is_helper_bone(joints[j].name);
    heir[j] = goes ? above : static_cast<int32_t>(kept.size());
    joints[j].parent = above;
    if (!goes) kept.push_back(j);
  }
  if (kept.size() == joints.size()) return kept;
  move_to(heir, character.rig);
  keep(kept, joints), keep(kept, character.tip), keep(kept, character.rest), keep(kept, character.confidence);
  keep(kept, character.left_out);
  return kept;
}

}  // namespace focal
