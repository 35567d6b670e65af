// The bytes of buffers and buffer views, loaded and decompressed on first use.
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "gltf/container.h"
#include "gltf/fields.h"
#include "gltf/view.h"

namespace focal {

// The path beside a document that a URI in it refers to; empty for others (an address, an absolute path).
// Backslashes count as slashes, and a % that starts no escape sequence is literal, as many exporters write
// them.
std::optional<std::filesystem::path> path_beside(const std::string& uri);

class GltfBuffers {
 public:
  // Buffers in other files are read from `folder`, or refused without one. The arguments must outlive this
  // object.
  GltfBuffers(const GltfView& view, const GltfContainer& container, const GltfLimits& limits,
              const std::optional<std::filesystem::path>& folder)
      : view_(view), container_(container), limits_(limits), folder_(folder) {}

  // The bytes of a view, EXT_meshopt_compression decoded; valid as long as this object. Throws invalid_file,
  // unsupported, file_not_found, io.
  std::span<const std::byte> view(int64_t index);

 private:
  std::span<const std::byte> buffer(int64_t index);
  std::vector<std::byte> load(const std::string& uri, const Place& place) const;
  std::span<const std::byte> extent(int64_t buffer, int64_t offset, int64_t length);
  std::vector<std::byte> decode(const tiny::Value& compressed, const Place& place);
  void charge(int64_t bytes);  // counts against limits_.decoded_bytes

  const GltfView& view_;
  const GltfContainer& container_;
  const GltfLimits& limits_;
  const std::optional<std::filesystem::path>& folder_;
  int64_t decoded_bytes_ = 0;
  std::map<int64_t, std::vector<std::byte>> loaded_buffers_, decoded_views_;
};

}  // namespace focal
