#include "gltf/accessor_writer.h"

#include "gltf/text.h"

namespace focal {

AccessorWriter::AccessorWriter(OrderedJson& root, std::span<const std::byte> bin, bool is_binary)
    : root_(root) {
  OrderedJson& buffers = member_or_new(root_, "buffers", OrderedJson::value_t::array);
  owns_bin_ = is_binary && (buffers.empty() || !find(buffers[0], "uri"));  // else buffer 0 is not the chunk
  if (owns_bin_ && !buffers.empty()) {
    data_.assign(bin.begin(), bin.end());
    data_.resize(buffers[0]["byteLength"].get<size_t>());  // without the chunk's padding
    return;
  }
  buffer_ = append_element(root_, "buffers");
  at(root_["buffers"][buffer_], "byteLength") = 0;
}

size_t AccessorWriter::add(std::span<const std::byte> values, int component_type, size_t count,
                           int components, ViewTarget target) {
  data_.resize((data_.size() + 3) / 4 * 4);
  const size_t view_index = append_element(root_, "bufferViews");
  OrderedJson& view = root_["bufferViews"][view_index];
  view["buffer"] = buffer_;
  view["byteOffset"] = data_.size();
  view["byteLength"] = values.size();
  if (target != ViewTarget::none) view["target"] = static_cast<int>(target);
  data_.insert(data_.end(), values.begin(), values.end());
  const size_t index = append_element(root_, "accessors");
  OrderedJson& accessor = root_["accessors"][index];
  accessor["bufferView"] = view_index;
  accessor["count"] = count;
  accessor["componentType"] = component_type;
  accessor["type"] = components == 1   ? "SCALAR"
                     : components == 3 ? "VEC3"
                     : components == 4 ? "VEC4"
                                       : "MAT4";
  return index;
}

void AccessorWriter::put_bounds(size_t index, std::span<const double> low, std::span<const double> high) {
  put_numbers(accessor(index), "min", low);
  put_numbers(accessor(index), "max", high);
}

std::vector<std::byte> AccessorWriter::finish() {
  OrderedJson& buffer = root_["buffers"][buffer_];
  buffer["byteLength"] = data_.size();
  if (owns_bin_) return std::move(data_);
  at(buffer, "uri") = "data:application/octet-stream;base64," + base64(data_);
  return {};
}

}  // namespace focal
