// The numbers an accessor stands for (glTF 2.0, section 3.6.2). Counts, types and extents were checked by parse_gltf.
#include "gltf/accessor.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>

#include "base/error.h"
#include "gltf/fields.h"

namespace focal {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "glTF data is little-endian and read as it stands");

// Where entries lie: entry i begins at data[i * stride].
struct Source {
  std::span<const std::byte> data;
  int64_t stride;
};

template <class T>
double value_at(const std::byte* at, bool normalized) {
  T value;
  std::memcpy(&value, at, sizeof value);
  if constexpr (std::is_integral_v<T>)
    if (normalized) return std::max(double(value) / double(std::numeric_limits<T>::max()), -1.0);
  return value;
}

template <class T>
void copy_entries(const Source& source, const Element& element, RowMatrix& rows) {
  const int32_t per_column = element.components / element.columns;
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const std::byte* const entry = source.data.data() + row * source.stride;
    for (int32_t component = 0; component < element.components; ++component) {
      const int64_t offset = component / per_column * element.column_size() +
                             component % per_column * static_cast<int64_t>(sizeof(T));
      rows(row, component) = value_at<T>(entry + offset, element.normalized);
    }
  }
}

RowMatrix entries(const Source& source, const Element& element, int64_t count) {
  RowMatrix rows(count, element.components);
  switch (element.type) {
    case ComponentType::i8:
      copy_entries<int8_t>(source, element, rows);
      break;
    case ComponentType::u8:
      copy_entries<uint8_t>(source, element, rows);
      break;
    case ComponentType::i16:
      copy_entries<int16_t>(source, element, rows);
      break;
    case ComponentType::u16:
      copy_entries<uint16_t>(source, element, rows);
      break;
    case ComponentType::u32:
      copy_entries<uint32_t>(source, element, rows);
      break;
    case ComponentType::f32:
      copy_entries<float>(source, element, rows);
      break;
  }
  return rows;
}

// The data `owner` (an accessor, or an end of a sparse one) points at.
Source source_of(const json& root, GltfBuffers& buffers, const json& owner, int64_t size,
                 bool may_be_strided) {
  const int64_t view = checked_integer(owner, "bufferView"), offset = checked_integer(owner, "byteOffset");
  const json& entry = list(root, "bufferViews")[static_cast<size_t>(view)];
  const int64_t stride = may_be_strided ? checked_integer(entry, "byteStride", size) : size;
  return {buffers.view(view).subspan(static_cast<size_t>(offset)), stride};
}

void put_sparse(const json& root, GltfBuffers& buffers, const json& sparse, const Place& place,
                const Element& element, RowMatrix& rows) {
  const int64_t count = checked_integer(sparse, "count");
  Element index;
  index.type = static_cast<ComponentType>(checked_integer(sparse["indices"], "componentType"));
  const auto places = entries(source_of(root, buffers, sparse["indices"], index.size(), false), index, count);
  const auto values =
      entries(source_of(root, buffers, sparse["values"], element.size(), false), element, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    if (places(i) >= static_cast<double>(rows.rows()))
      fail_field(place, "sparse", "replaces an entry that is not there");
    rows.row(static_cast<Eigen::Index>(places(i))) = values.row(i);
  }
}

}  // namespace

RowMatrix read_accessor(const json& root, GltfBuffers& buffers, int64_t index) {
  const Place place{"accessors", index};
  const json& accessor = list(root, "accessors")[static_cast<size_t>(index)];
  const Element element = element_of(accessor, place);
  RowMatrix rows;
  if (member(accessor, "bufferView"))
    rows = entries(source_of(root, buffers, accessor, element.size(), true), element, element.count);
  else
    rows = RowMatrix::Zero(element.count, element.components);
  if (const json* sparse = member(accessor, "sparse"))
    put_sparse(root, buffers, *sparse, place, element, rows);
  return rows;
}

}  // namespace focal
