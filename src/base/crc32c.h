// CRC-32C (Castagnoli polynomial, as in RFC 3720), the checksum of focal's files.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace focal {

// Detects every error burst of at most 32 bits, so every single corrupt byte. To continue over several
// blocks, pass the previous result.
uint32_t crc32c(std::span<const std::byte> bytes, uint32_t previous = 0);

}  // namespace focal
