// Layout of one entry of an accessor.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>

#include "gltf/fields.h"

namespace focal {

enum class ComponentType : int32_t { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

int64_t component_size(ComponentType type);
bool is_index_type(ComponentType type);  // unsigned integers

struct Element {
  ComponentType type = ComponentType::f32;
  bool normalized = false;
  int32_t components = 1;  // of all columns together
  int32_t columns = 1;     // more than 1 for matrices, whose columns start at multiples of 4 bytes
  int64_t count = 0;       // entries of the accessor

  int64_t column_size() const;  // with the padding after a column
  int64_t size() const { return column_size() * columns; }
  // Bytes from the first entry to the end of the last, which has no padding after it.
  int64_t extent(int64_t entries, int64_t stride) const;
};

// Throws invalid_file when the type, component type or count is invalid.
Element element_of(const nlohmann::json& accessor, const Place& place);

}  // namespace focal
