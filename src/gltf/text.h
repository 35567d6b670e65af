// Small helpers for text from untrusted files.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace focal {

// Text for a message: printable ASCII, at most 200 characters.
std::string printable(std::string_view text);

// Resolves percent escapes; a % that starts none is kept.
std::string percent_decoded(std::string_view uri);

// Bytes of the base64 payload of a "data:...;base64,..." URI; empty if malformed. RFC 2397, RFC 4648.
std::optional<std::vector<std::byte>> data_uri_bytes(std::string_view uri);
bool is_data_uri(std::string_view uri);

std::string base64(std::span<const std::byte> bytes);

}  // namespace focal
