// Adds data to a document: accessors and views, and their buffer.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "gltf/document_edit.h"

namespace focal {

enum class ViewTarget { none = 0, vertices = 34962, indices = 34963 };

class AccessorWriter {
 public:
  // bin: the BIN chunk of a .glb, which is extended; in a .gltf, or where buffer 0 is something else, adds a
  // buffer with a data: URI.
  AccessorWriter(OrderedJson& root, std::span<const std::byte> bin, bool is_binary);

  // components: 1, 3, 4 or 16 (a matrix) numbers per entry. Returns the accessor's index.
  template <class T>
  size_t add(const std::vector<T>& values, int components, ViewTarget target = ViewTarget::none) {
    return add(std::as_bytes(std::span(values)), component_type<T>(),
               values.size() / static_cast<size_t>(components), components, target);
  }
  OrderedJson& accessor(size_t index) { return root_["accessors"][index]; }
  void put_bounds(size_t accessor, std::span<const double> low, std::span<const double> high);

  // Sets the length of the buffer. Returns the BIN chunk; empty when the data went into a buffer of its own.
  std::vector<std::byte> finish();

 private:
  template <class T>
  static constexpr int component_type() {
    if constexpr (std::is_same_v<T, uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, uint32_t>) return 5125;
    return 5126;
  }
  size_t add(std::span<const std::byte> values, int component_type, size_t count, int components,
             ViewTarget target);

  OrderedJson& root_;
  std::vector<std::byte> data_;  // of buffer_, from its start
  bool owns_bin_;
  size_t buffer_ = 0;
};

}  // namespace focal
