// Layout of one entry of an accessor (glTF 2.0, section 3.6.2).
#include "gltf/element.h"

#include <array>
#include <string_view>

namespace focal {

int64_t component_size(ComponentType type) {
  switch (type) {
    case ComponentType::i8:
    case ComponentType::u8:
      return 1;
    case ComponentType::i16:
    case ComponentType::u16:
      return 2;
    case ComponentType::u32:
    case ComponentType::f32:
      return 4;
  }
  return 0;
}

bool is_index_type(ComponentType type) {
  return type == ComponentType::u8 || type == ComponentType::u16 || type == ComponentType::u32;
}

int64_t Element::column_size() const {
  const int64_t packed = component_size(type) * (components / columns);
  return columns == 1 ? packed : (packed + 3) / 4 * 4;
}

int64_t Element::extent(int64_t entries, int64_t stride) const {
  const int64_t last = column_size() * (columns - 1) + component_size(type) * (components / columns);
  return (entries - 1) * stride + last;
}

Element element_of(const nlohmann::json& accessor, const Place& place) {
  struct Kind {
    std::string_view name;
    int32_t components, columns;
  };
  constexpr std::array<Kind, 7> kinds{{{"SCALAR", 1, 1},
                                       {"VEC2", 2, 1},
                                       {"VEC3", 3, 1},
                                       {"VEC4", 4, 1},
                                       {"MAT2", 4, 2},
                                       {"MAT3", 9, 3},
                                       {"MAT4", 16, 4}}};
  Element element;
  element.type = static_cast<ComponentType>(integer(accessor, "componentType", place, 5120, 5126));
  if (component_size(element.type) == 0)
    fail_field(place, "componentType", "is not a component type of glTF");
  element.count = integer(accessor, "count", place, 0, max_file_bytes);
  const auto* normalized = member(accessor, "normalized");
  if (normalized && !normalized->is_boolean()) fail_field(place, "normalized", "is not a boolean");
  element.normalized = normalized && normalized->get<bool>();
  const std::string* name = text(accessor, "type", place);
  for (const Kind& kind : kinds) {
    if (!name || kind.name != *name) continue;
    element.components = kind.components;
    element.columns = kind.columns;
    return element;
  }
  fail_field(place, "type", "is missing or not a type of glTF");
}

}  // namespace focal
