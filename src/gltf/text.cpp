// Small helpers for text from untrusted files.
#include "gltf/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>

namespace focal {
namespace {

constexpr std::array<int8_t, 256> base64_values() {
  std::array<int8_t, 256> values{};
  values.fill(-1);
  constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < alphabet.size(); ++i) values[static_cast<uint8_t>(alphabet[i])] = int8_t(i);
  return values;
}

std::optional<std::vector<std::byte>> base64_decoded(std::string_view text) {
  constexpr auto base64_table = base64_values();
  for (int padding = 0; padding < 2 && !text.empty() && text.back() == '='; ++padding) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    const int8_t value = base64_table[static_cast<uint8_t>(c)];
    if (value < 0) return std::nullopt;
    bits = (bits << 6 | static_cast<uint32_t>(value)) & 0xffffff;
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> bit_count & 0xff));
  }
  return bytes;
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr size_t longest_name = 200;
  std::string result(text.substr(0, longest_name));
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.size() > longest_name ? result + "..." : result;
}

std::string percent_decoded(std::string_view uri) {
  std::string result;
  for (size_t i = 0; i < uri.size(); ++i) {
    uint8_t value = 0;
    const char* const digits = uri.data() + i + 1;
    const bool is_escape = uri[i] == '%' && uri.size() - i > 2 &&
                           std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2;
    result += is_escape ? static_cast<char>(value) : uri[i];
    if (is_escape) i += 2;
  }
  return result;
}

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

std::optional<std::vector<std::byte>> data_uri_bytes(std::string_view uri) {
  constexpr std::string_view base64_marker = ";base64,";
  const size_t marker = uri.substr(0, 256).find(base64_marker);
  if (!is_data_uri(uri) || marker == std::string_view::npos) return std::nullopt;
  return base64_decoded(uri.substr(marker + base64_marker.size()));
}

std::string base64(std::span<const std::byte> bytes) {
  constexpr char base64_digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    for (size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? std::to_integer<uint32_t>(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k) result += k <= count ? base64_digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return result;
}

}  // namespace focal
