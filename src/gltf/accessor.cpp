// Reads the numbers of an accessor (glTF 2.0, section 3.6.2). parse_gltf has checked counts, types and
// extents.
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

static_assert(std::endian::native == std::endian::little,
              "glTF data is little-endian and read without conversion");

// Position of the entries: entry i starts at data[i * stride].
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

Element element_of(const tiny::Accessor& accessor) {
  Element element;
  element.type = static_cast<ComponentType>(accessor.componentType);
  element.normalized = accessor.normalized;
  element.components = tiny::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
  if (accessor.type >= TINYGLTF_TYPE_MAT2 && accessor.type <= TINYGLTF_TYPE_MAT4)
    element.columns = accessor.type - TINYGLTF_TYPE_MAT2 + 2;
  element.count = static_cast<int64_t>(accessor.count);
  return element;
}

int64_t stride_of(const tiny::BufferView& view, int64_t packed) {
  if (const tiny::Value* odd = extension(view.extensions, "focal_stride")) return odd->GetNumberAsInt();
  return view.byteStride > 0 ? static_cast<int64_t>(view.byteStride) : packed;
}

// The values of a sparse accessor, or their indices.
Source packed_source(GltfBuffers& buffers, int64_t view, int64_t offset, const Element& element) {
  return {buffers.view(view).subspan(static_cast<size_t>(offset)), element.size()};
}

void put_sparse(const tiny::Accessor& accessor, GltfBuffers& buffers, const Place& place,
                const Element& element, RowMatrix& rows) {
  const auto& sparse = accessor.sparse;
  Element index;
  index.type = static_cast<ComponentType>(sparse.indices.componentType);
  const auto places =
      entries(packed_source(buffers, sparse.indices.bufferView, sparse.indices.byteOffset, index), index,
              sparse.count);
  const auto values =
      entries(packed_source(buffers, sparse.values.bufferView, sparse.values.byteOffset, element), element,
              sparse.count);
  for (Eigen::Index i = 0; i < sparse.count; ++i) {
    if (places(i) >= static_cast<double>(rows.rows()))
      fail_field(place, "sparse", "replaces an entry that does not exist");
    rows.row(static_cast<Eigen::Index>(places(i))) = values.row(i);
  }
}

}  // namespace

RowMatrix read_accessor(const GltfView& view, GltfBuffers& buffers, int64_t index) {
  const tiny::Accessor& accessor = view.model.accessors[static_cast<size_t>(index)];
  const Element element = element_of(accessor);
  RowMatrix rows = RowMatrix::Zero(element.count, element.components);
  if (has_view(view.model, accessor) && element.count > 0) {
    const auto bytes = buffers.view(accessor.bufferView).subspan(accessor.byteOffset);
    const auto& from = view.model.bufferViews[static_cast<size_t>(accessor.bufferView)];
    rows = entries({bytes, stride_of(from, element.size())}, element, element.count);
  }
  if (accessor.sparse.isSparse) put_sparse(accessor, buffers, {"accessors", index}, element, rows);
  return rows;
}

}  // namespace focal
