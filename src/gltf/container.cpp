// The GLB container: a header of 12 bytes, then chunks of length, type and data (glTF 2.0, section 4).
#include "gltf/container.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "gltf/foreign_file.h"

namespace focal {
namespace {

constexpr uint32_t glb_magic = 0x46546c67, format_version = 2, json_type = 0x4e4f534a, bin_type = 0x004e4942;
constexpr size_t header_size = 12, chunk_header_size = 8;

uint32_t little_endian_at(std::span<const std::byte> bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 4; i-- > 0;) value = value << 8 | static_cast<uint32_t>(bytes[at + i]);
  return value;
}

Error broken_file(const std::string& what) {
  return Error(Status::invalid_file, "GLB: " + what,
               "the file is truncated or corrupt; copy or export it again");
}

struct Chunk {
  uint32_t type;
  std::span<const std::byte> data;
};

// Removes the next chunk from the front of `bytes`.
Chunk take_chunk(std::span<const std::byte>& bytes) {
  if (bytes.size() < chunk_header_size) throw broken_file("a chunk header is cut off");
  const size_t length = little_endian_at(bytes, 0);
  if (length > bytes.size() - chunk_header_size)
    throw broken_file("a chunk of " + std::to_string(length) + " bytes, but only " +
                      std::to_string(bytes.size() - chunk_header_size) + " are left");
  const Chunk chunk{little_endian_at(bytes, 4), bytes.subspan(chunk_header_size, length)};
  bytes = bytes.subspan(chunk_header_size + length);
  return chunk;
}

void open_binary(std::span<const std::byte> bytes, GltfContainer& container) {
  if (bytes.size() < header_size) throw broken_file("the header is cut off");
  const uint32_t version = little_endian_at(bytes, 4);
  if (version != 2)
    throw Error(Status::unsupported, "GLB of version " + std::to_string(version),
                "convert the file to glTF 2.0");
  const size_t length = little_endian_at(bytes, 8);
  if (length < header_size || length > bytes.size())
    throw broken_file("the header announces " + std::to_string(length) + " bytes, the file has " +
                      std::to_string(bytes.size()));
  auto left = bytes.subspan(header_size, length - header_size);
  const Chunk first = take_chunk(left);
  if (first.type != json_type || first.data.empty()) throw broken_file("the first chunk is not JSON");
  container.json = first.data;
  container.rest = left;
  while (!left.empty()) {
    const Chunk chunk = take_chunk(left);
    if (chunk.type == json_type) throw broken_file("two JSON chunks");
    if (chunk.type != bin_type) continue;
    if (container.has_bin) throw broken_file("two BIN chunks");
    container.bin = chunk.data;
    container.has_bin = true;
  }
}

void put_u32(std::vector<std::byte>& bytes, uint64_t value) {
  if (value >> 32)
    throw Error(Status::unsupported, "a .glb cannot hold more than 4 GiB", "decimate the model");
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::byte>(value >> shift & 0xff));
}

uint64_t padded(uint64_t size) { return (size + 3) / 4 * 4; }

void put_chunk(std::vector<std::byte>& bytes, uint32_t type, std::span<const std::byte> data, char padding) {
  put_u32(bytes, padded(data.size()));
  put_u32(bytes, type);
  bytes.insert(bytes.end(), data.begin(), data.end());
  bytes.insert(bytes.end(), padded(data.size()) - data.size(), static_cast<std::byte>(padding));
}

}  // namespace

GltfContainer open_container(std::span<const std::byte> bytes, const GltfLimits& limits) {
  if (bytes.empty()) throw Error(Status::invalid_file, "the file is empty", "pass a .glb or .gltf file");
  GltfContainer container;
  container.binary = bytes.size() >= 4 && little_endian_at(bytes, 0) == glb_magic;
  if (container.binary) {
    open_binary(bytes, container);
  } else {
    refuse_foreign_file(bytes);
    container.json = bytes;
  }
  if (static_cast<int64_t>(container.json.size()) > limits.json_bytes)
    throw Error(Status::unsupported, "glTF with " + std::to_string(container.json.size()) + " bytes of JSON",
                "save it as .glb, which keeps the geometry out of the JSON, or raise the limit");
  return container;
}

std::vector<std::byte> glb_bytes(std::string_view json, std::span<const std::byte> chunks) {
  constexpr uint64_t headers = header_size + chunk_header_size;
  std::vector<std::byte> bytes;
  const uint64_t size = headers + padded(json.size()) + chunks.size();
  put_u32(bytes, glb_magic);
  put_u32(bytes, format_version);
  put_u32(bytes, size);
  bytes.reserve(size);
  put_chunk(bytes, json_type, std::as_bytes(std::span(json)), ' ');
  bytes.insert(bytes.end(), chunks.begin(), chunks.end());
  return bytes;
}

std::vector<std::byte> bin_chunk(std::span<const std::byte> data) {
  std::vector<std::byte> bytes;
  bytes.reserve(8 + padded(data.size()));
  put_chunk(bytes, bin_type, data, '\0');
  return bytes;
}

std::vector<std::byte> with_content(const GltfContainer& container, std::string_view json,
                                    std::span<const std::byte> bin) {
  if (!container.binary) {
    const auto bytes = std::as_bytes(std::span(json));
    return {bytes.begin(), bytes.end()};
  }
  if (bin.empty()) return glb_bytes(json, container.rest);
  std::vector<std::byte> chunks = bin_chunk(bin);
  size_t first = 0, behind = 0;  // range of the old BIN chunk
  if (container.has_bin) {
    first = static_cast<size_t>(container.bin.data() - container.rest.data()) - chunk_header_size;
    behind = first + chunk_header_size + container.bin.size();
  }
  const auto& rest = container.rest;
  chunks.insert(chunks.begin(), rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(first));
  chunks.insert(chunks.end(), rest.begin() + static_cast<std::ptrdiff_t>(behind), rest.end());
  return glb_bytes(json, chunks);
}

}  // namespace focal
