// Whole files in and out: a read that cannot block or run away, a write that is all or nothing.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace focal {

inline constexpr int64_t kDefaultFileLimit = int64_t{4} << 30;  // bytes

// UTF-8 on every platform.
std::string text_of(const std::filesystem::path& path);

// The bytes of a regular file (links are followed). A pipe, device or folder is refused without blocking.
// Throws file_not_found, invalid_file (not a regular file), unsupported (more than size_limit bytes), io.
std::vector<std::byte> read_file(const std::filesystem::path& path, int64_t size_limit = kDefaultFileLimit);

// The same for a file named by an untrusted document: `relative` must stay inside `folder`, and no part of it
// may be a link. Also throws invalid_file for an absolute path or one with "..".
std::vector<std::byte> read_file_inside(const std::filesystem::path& folder,
                                        const std::filesystem::path& relative,
                                        int64_t size_limit = kDefaultFileLimit);

// After a normal return the file holds exactly `bytes`, on disk; after an exception or a crash it is the old file,
// if any, or (when only the folder could not be flushed) the new one, whole. Throws io, invalid_argument (the path is a folder, device or pipe), file_not_found (no
// such folder).
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace focal
