// The bytes behind buffers and buffer views, fetched and decompressed when first asked for.
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "gltf/fields.h"
#include "gltf/preflight.h"

namespace focal {

class GltfBuffers {
 public:
  // `root` has passed parse_gltf. Buffers in other files are read from `folder`, or refused without one.
  GltfBuffers(const nlohmann::json& root, const GltfContainer& container, const GltfLimits& limits,
              std::optional<std::filesystem::path> folder);

  // The view's bytes, EXT_meshopt_compression decoded; valid as long as this object.
  // Throws invalid_file, unsupported, file_not_found, io.
  std::span<const std::byte> view(int64_t index);

 private:
  std::span<const std::byte> buffer(int64_t index);
  std::vector<std::byte> load(const std::string& uri, const Place& place) const;
  std::vector<std::byte> decode(const nlohmann::json& compressed, const Place& place);
  void charge(int64_t bytes);  // against limits_.decoded_bytes

  const nlohmann::json& root_;
  const GltfContainer& container_;
  const GltfLimits& limits_;
  std::optional<std::filesystem::path> folder_;
  int64_t decoded_bytes_ = 0;
  std::map<int64_t, std::vector<std::byte>> loaded_buffers_, decoded_views_;
};

}  // namespace focal
