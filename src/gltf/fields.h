// Typed, range-checked reads of JSON members, with error messages that name the location.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace focal {

// An element of a top-level list, for messages: accessors[3]. Stored as numbers, since most are never
// printed.
struct Place {
  const char* list;
  int64_t index = -1;  // -1: the list itself
  std::string text() const;
};

inline constexpr int64_t max_file_bytes = int64_t{1}
                                          << 40;  // products of two such counts and a stride stay in int64

// Throws invalid_file "accessors[3].count: ...".
[[noreturn]] void fail_field(const Place& place, const char* key, const std::string& what);

const nlohmann::json* member(const nlohmann::json& object, const char* key);  // null if missing

// A whole number (1.0 is one) in [least, most]; if missing `fallback`, or an error without a fallback.
int64_t integer(const nlohmann::json& object, const char* key, const Place& place, int64_t least,
                int64_t most, std::optional<int64_t> fallback = std::nullopt);
// The same where parse_gltf has already checked that the number exists and is in range, or may be missing.
int64_t checked_integer(const nlohmann::json& object, const char* key, int64_t fallback = 0);
// A reference into a list of `count`; if missing -1, or an error when required.
int64_t reference(const nlohmann::json& object, const char* key, const Place& place, int64_t count,
                  bool required = false);
// The same for an element of an array or an attribute.
int64_t as_reference(const nlohmann::json& value, const char* key, const Place& place, int64_t count);

// The member if it has this kind, null if missing; any other kind is an error.
const nlohmann::json* array(const nlohmann::json& object, const char* key, const Place& place);
const nlohmann::json* object(const nlohmann::json& object, const char* key, const Place& place);
const std::string* text(const nlohmann::json& object, const char* key, const Place& place);

// A top-level list, or an empty array if missing.
const nlohmann::json& list(const nlohmann::json& root, const char* key);

// An extension object of an element, or null.
const nlohmann::json* extension(const nlohmann::json& element, const char* name);

}  // namespace focal
