// Reads buffers from the GLB chunk, data: URIs and neighbouring files; decodes buffer views with
// EXT_meshopt_compression.
#include "gltf/buffers.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <string>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "gltf/fields.h"
#include "gltf/text.h"

namespace focal {
namespace {

// Each decoder's preconditions are asserts in the library, so they are checked here.
bool decode_mode(const std::string& mode, std::vector<std::byte>& out, size_t count, size_t stride,
                 std::span<const std::byte> in) {
  const auto* data = reinterpret_cast<const unsigned char*>(in.data());
  const bool is_index_stride = stride == 2 || stride == 4;
  if (mode == "ATTRIBUTES")
    return stride % 4 == 0 && meshopt_decodeVertexBuffer(out.data(), count, stride, data, in.size()) == 0;
  if (mode == "TRIANGLES")
    return is_index_stride && count % 3 == 0 &&
           meshopt_decodeIndexBuffer(out.data(), count, stride, data, in.size()) == 0;
  if (mode == "INDICES")
    return is_index_stride && meshopt_decodeIndexSequence(out.data(), count, stride, data, in.size()) == 0;
  return false;
}

bool apply_filter(const std::string& filter, std::vector<std::byte>& bytes, size_t count, size_t stride) {
  if (filter == "NONE") return true;
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
    meshopt_decodeFilterOct(bytes.data(), count, stride);
  else if (filter == "QUATERNION" && stride == 8)
    meshopt_decodeFilterQuat(bytes.data(), count, stride);
  else if (filter == "EXPONENTIAL" && stride % 4 == 0)
    meshopt_decodeFilterExp(bytes.data(), count, stride);
  else
    return false;
  return true;
}

}  // namespace

std::optional<std::filesystem::path> path_beside(const std::string& uri) {
  std::string path = percent_decoded(uri);
  std::replace(path.begin(), path.end(), '\\', '/');
  const bool is_name =
      !path.empty() && path.find('\0') == std::string::npos && path.find(':') == std::string::npos;
  return is_name ? path_from_text(path) : std::nullopt;
}

std::span<const std::byte> GltfBuffers::view(int64_t index) {
  const Place place{"bufferViews", index};
  const tiny::BufferView& view = view_.model.bufferViews[static_cast<size_t>(index)];
  const tiny::Value* compressed = extension(view.extensions, "EXT_meshopt_compression");
  if (!compressed)
    return extent(view.buffer, static_cast<int64_t>(view.byteOffset), static_cast<int64_t>(view.byteLength));
  auto found = decoded_views_.find(index);
  if (found == decoded_views_.end()) found = decoded_views_.emplace(index, decode(*compressed, place)).first;
  return found->second;
}

// parse_gltf has checked that the extent is within the buffer's length, and buffer() that this many bytes
// exist.
std::span<const std::byte> GltfBuffers::extent(int64_t index, int64_t offset, int64_t length) {
  return buffer(index).subspan(static_cast<size_t>(offset), static_cast<size_t>(length));
}

std::span<const std::byte> GltfBuffers::buffer(int64_t index) {
  const Place place{"buffers", index};
  const BufferSource& source = view_.buffers[static_cast<size_t>(index)];
  std::span<const std::byte> bytes;
  if (source.uri) {
    auto found = loaded_buffers_.find(index);
    if (found == loaded_buffers_.end()) {
      if (is_data_uri(*source.uri)) charge(static_cast<int64_t>(source.uri->size() / 4 * 3));
      found = loaded_buffers_.emplace(index, load(*source.uri, place)).first;
    }
    bytes = found->second;
  } else if (index == 0 && container_.has_bin) {
    bytes = container_.bin;
  } else {
    fail_field(place, "uri", "is missing and there is no BIN chunk for it");
  }
  if (static_cast<int64_t>(bytes.size()) < source.length)
    fail_field(place, "byteLength",
               "is " + std::to_string(source.length) + ", but the buffer has " +
                   std::to_string(bytes.size()) + " bytes");
  return bytes;
}

std::vector<std::byte> GltfBuffers::load(const std::string& uri, const Place& place) const {
  if (is_data_uri(uri)) {
    auto bytes = data_uri_bytes(uri);
    if (!bytes) fail_field(place, "uri", "is not a well-formed base64 data URI");
    return std::move(*bytes);
  }
  const auto path = path_beside(uri);
  if (!path) fail_field(place, "uri", "is neither data nor the name of a file beside this one");
  if (!folder_)
    throw Error(Status::unsupported, "the buffer lies in another file, '" + printable(path->string()) + "'",
                "allow external files, or save the model as one .glb");
  return read_file_inside(*folder_, *path, limits_.file_bytes);
}

std::vector<std::byte> GltfBuffers::decode(const tiny::Value& compressed, const Place& place) {
  const auto number = [&](const char* key) { return int64_t{compressed.Get(key).GetNumberAsInt()}; };
  const auto word = [&](const char* key) {
    return compressed.Has(key) ? compressed.Get(key).Get<std::string>() : std::string("NONE");
  };
  const auto source = extent(number("buffer"), number("byteOffset"), number("byteLength"));
  const int64_t count = number("count"), stride = number("byteStride");
  // The maximum compression ratio of the codecs, so that a tiny file cannot request a huge block.
  constexpr int64_t best_ratio = 1024;
  if (count * stride > best_ratio * static_cast<int64_t>(source.size()))
    fail_field(place, "extensions", "EXT_meshopt_compression announces more data than it can hold");
  charge(count * stride);
  std::vector<std::byte> bytes(static_cast<size_t>(count * stride));
  if (!decode_mode(word("mode"), bytes, static_cast<size_t>(count), static_cast<size_t>(stride), source) ||
      !apply_filter(word("filter"), bytes, static_cast<size_t>(count), static_cast<size_t>(stride)))
    fail_field(place, "extensions", "EXT_meshopt_compression data cannot be decoded");
  return bytes;
}

void GltfBuffers::charge(int64_t bytes) {
  decoded_bytes_ += bytes;
  if (decoded_bytes_ > limits_.decoded_bytes)
    throw Error(Status::unsupported,
                "buffers of more than " + std::to_string(limits_.decoded_bytes) + " bytes after decoding",
                "reduce the file or raise the limit");
}

}  // namespace focal
