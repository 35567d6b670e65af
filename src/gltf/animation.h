// What the animations of a file do to its joints.
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/matrix.h"
#include "gltf/limits.h"

namespace focal {

struct GltfAnimation {
  std::string name;
  std::vector<double> times;                           // seconds, ascending
  std::map<std::string, std::vector<Matrix4>> joints;  // by name: to world coordinates, one a time
};

// Sampled at the times of all keys of an animation together, at most `most_keys` of them (evenly chosen). Only joints of skins that
// are worn, of two with one name the first, and only animations that move one of them. Morph weights and what is animated through
// extensions are left out. Throws what read_gltf throws; unsupported when the matrices take more than limits.decoded_bytes.
std::vector<GltfAnimation> read_gltf_animations(std::span<const std::byte> bytes,
                                                const GltfLimits& limits = {},
                                                std::optional<std::filesystem::path> folder = std::nullopt,
                                                int32_t most_keys = 2000);

// Between two of the times the matrices are mixed; before the first and past the last they stay.
Matrix4 at_time(const std::vector<double>& times, const std::vector<Matrix4>& matrices, double time);

}  // namespace focal
