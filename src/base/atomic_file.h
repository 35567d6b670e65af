// Reads and writes whole files: a read never blocks and has a size limit, a write is atomic.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace focal {

inline constexpr int64_t default_file_limit = int64_t{4} << 30;  // bytes

// UTF-8 on every platform.
std::string text_of(const std::filesystem::path& path);

// Null if the text cannot name a file; on Windows: if it is not UTF-8.
std::optional<std::filesystem::path> path_from_text(std::string_view text);

// Reads the bytes of a regular file (links are followed). A pipe, device or folder is refused without
// blocking. Throws file_not_found, invalid_file (not a regular file), unsupported (more than size_limit
// bytes), io.
std::vector<std::byte> read_file(const std::filesystem::path& path, int64_t size_limit = default_file_limit);

// The same for a file named by an untrusted document: `relative` must stay inside `folder`, and no component
// of it may be a link. Also throws invalid_file for an absolute path or one with "..", and on Windows for one
// with a drive, a stream of a file or a device such as NUL.
std::vector<std::byte> read_file_inside(const std::filesystem::path& folder,
                                        const std::filesystem::path& relative,
                                        int64_t size_limit = default_file_limit);

// After a normal return the file on disk contains exactly `bytes`. After an exception or a crash it is the
// complete old file, if any, or (when only the flush of the folder failed) the complete new one. Throws io,
// invalid_argument (the path is a folder, device or pipe), file_not_found (no such folder).
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace focal
