// Plain C arguments, checked: paths, blocks of bytes, indices, texts by number.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace focal {

// UTF-8 on every platform. Throws invalid_argument: NULL or empty.
std::filesystem::path path_of(const char* path);

// Throws invalid_argument: NULL, or a size beyond the address space.
std::span<const std::byte> bytes_of(const void* data, uint64_t size);

// Throws invalid_argument: "OWNER has 3 THINGS, not a number 7".
void check_index(uint64_t index, uint64_t count, const char* owner, const char* things);
const char* text_at(const std::vector<std::string>& texts, uint64_t index, const char* owner,
                    const char* things);

}  // namespace focal
