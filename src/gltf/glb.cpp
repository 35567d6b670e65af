// Putting a .glb together (glTF 2.0, section 4).
#include "gltf/glb.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace focal {
namespace {

constexpr uint32_t kMagic = 0x46546c67, kVersion = 2, kJson = 0x4e4f534a, kBin = 0x004e4942;

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

std::vector<std::byte> glb_bytes(std::string_view json, std::span<const std::byte> chunks) {
  constexpr uint64_t kHeaders = 12 + 8;
  std::vector<std::byte> bytes;
  const uint64_t size = kHeaders + padded(json.size()) + chunks.size();
  put_u32(bytes, kMagic);
  put_u32(bytes, kVersion);
  put_u32(bytes, size);
  bytes.reserve(size);
  put_chunk(bytes, kJson, std::as_bytes(std::span(json)), ' ');
  bytes.insert(bytes.end(), chunks.begin(), chunks.end());
  return bytes;
}

std::vector<std::byte> bin_chunk(std::span<const std::byte> data) {
  std::vector<std::byte> bytes;
  bytes.reserve(8 + padded(data.size()));
  put_chunk(bytes, kBin, data, '\0');
  return bytes;
}

std::string json_string(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json_number(double finite) {
  std::array<char, 32> digits;
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(finite)).ptr;
  return std::string(digits.data(), end);
}

std::string json_array(const Vector3& finite) {
  return "[" + json_number(finite(0)) + "," + json_number(finite(1)) + "," + json_number(finite(2)) + "]";
}

}  // namespace focal
