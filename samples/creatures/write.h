// Characters and sets as files.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "character.h"

namespace creatures {

// NAME.glb (posed, no rig), NAME.rig.glb (at rest, with its skin and one animation), NAME.joints.json, NAME.landmarks.json.
void write_character(const Character& character, const std::filesystem::path& folder);

// set.json: which characters to learn from, which to be judged on.
void write_set(const Family& family, const std::vector<Character>& characters, int train_count, uint64_t seed,
               const std::filesystem::path& folder);

}  // namespace creatures
