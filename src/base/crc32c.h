// CRC-32C (Castagnoli polynomial, as in RFC 3720), the checksum of focal's files.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace focal {

// Finds every error burst of at most 32 bits, so every flipped byte. Chain blocks by passing the last result.
uint32_t crc32c(std::span<const std::byte> bytes, uint32_t previous = 0);

}  // namespace focal
