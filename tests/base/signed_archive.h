// The layout of docs/model-format.md, spelled out once more: tests of the file must not believe its writer.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "base/crc32c.h"

namespace focal_test {

inline uint64_t number_at(std::span<const std::byte> file, size_t at, int bytes) {
  uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value |= static_cast<uint64_t>(file[at + i]) << (8 * i);
  return value;
}

inline void put(std::vector<std::byte>& file, size_t at, uint32_t value) {
  for (int i = 0; i < 4; ++i) file[at + i] = std::byte(value >> (8 * i));
}

// Makes every checksum right again, so that damage reaches the code behind them. What lies outside the file is left as it is.
inline void sign(std::vector<std::byte>& file) {
  constexpr size_t header = 32, entry_size = 24;
  if (file.size() < header) return;
  const std::span<const std::byte> all(file);
  const uint64_t sections = number_at(file, 24, 4);
  if (sections > (file.size() - header) / entry_size) return;
  for (size_t entry = header; entry < header + sections * entry_size; entry += entry_size) {
    const uint64_t offset = number_at(file, entry + 8, 8), size = number_at(file, entry + 16, 8);
    if (offset <= file.size() && size <= file.size() - offset)
      put(file, entry + 4, focal::crc32c(all.subspan(offset, size)));
  }
  put(file, 28, focal::crc32c(all.subspan(header, sections * entry_size), focal::crc32c(all.first(28))));
}

// The file with another u32 in a section, its checksums right.
inline std::vector<std::byte> patched(std::vector<std::byte> file, std::string_view section, size_t at,
                                      uint32_t value) {
  size_t entry = 32;
  while (std::memcmp(&file.at(entry), section.data(), 4) != 0) entry += 24;
  put(file, number_at(file, entry + 8, 8) + at, value);
  sign(file);
  return file;
}

}  // namespace focal_test
