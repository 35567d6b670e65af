// Plain C arguments, checked: paths, blocks of bytes, indices, texts by number.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"

namespace focal {

// UTF-8 on every platform. Throws invalid_argument: NULL or empty.
std::filesystem::path path_of(const char* path);

std::string text_of(const std::filesystem::path& path);

// What goes wrong inside a file names the file: runs body(), puts the path before the message of an Error
// that lacks it and says nothing of handles or parameters.
template <class Body>
void naming_file(const std::filesystem::path& path, Body&& body) {
  try {
    body();
  } catch (const Error& error) {
    const std::string name = text_of(path), message = error.what();
    const bool about_call =
        error.status() == Status::invalid_handle || error.status() == Status::invalid_argument;
    if (about_call || message.find(name) != std::string::npos) throw;
    throw Error(error.status(), name + ": " + message, error.hint());
  }
}

// Throws invalid_argument: NULL, or a size beyond the address space.
std::span<const std::byte> bytes_of(const void* data, uint64_t size);

// Throws invalid_argument: "OWNER has 3 THINGS, not a number 7".
void check_index(uint64_t index, uint64_t count, const char* owner, const char* things);
// Throws invalid_argument: "vertex_count is 3, the mesh has 7 vertices".
void check_count(const char* name, uint64_t given, uint64_t wanted, const char* owner, const char* things);
const char* text_at(const std::vector<std::string>& texts, uint64_t index, const char* owner,
                    const char* things);

}  // namespace focal
