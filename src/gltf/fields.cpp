// Typed, range-checked reads of JSON members.
#include "gltf/fields.h"

#include <cmath>

#include "base/error.h"
#include "gltf/text.h"

namespace focal {
namespace {

using nlohmann::json;

std::optional<int64_t> whole_number(const json& value) {
  if (value.is_number_unsigned()) {
    const auto number = value.get<uint64_t>();
    return number <= uint64_t{INT64_MAX} ? std::optional<int64_t>(number) : std::nullopt;
  }
  if (value.is_number_integer()) return value.get<int64_t>();
  if (!value.is_number_float()) return std::nullopt;
  const double number = value.get<double>();
  constexpr double exact = 9007199254740992.0;  // 2^53
  if (!(std::abs(number) <= exact) || number != std::floor(number)) return std::nullopt;
  return static_cast<int64_t>(number);
}

const json* of_kind(const json& object, const char* key, const Place& place, json::value_t kind,
                    const char* name) {
  const json* value = member(object, key);
  if (value && value->type() != kind) fail_field(place, key, std::string("is not ") + name);
  return value;
}

}  // namespace

std::string Place::text() const {
  return index < 0 ? std::string(list) : std::string(list) + "[" + std::to_string(index) + "]";
}

void fail_field(const Place& place, const char* key, const std::string& what) {
  throw Error(Status::invalid_file, "glTF: " + place.text() + "." + printable(key) + " " + what,
              "the file is malformed; export it again or run a glTF validator on it");
}

const json* member(const json& object, const char* key) {
  const auto found = object.find(key);  // also end() when `object` is not an object
  return found == object.end() ? nullptr : &*found;
}

int64_t integer(const json& object, const char* key, const Place& place, int64_t least, int64_t most,
                std::optional<int64_t> fallback) {
  const json* value = member(object, key);
  if (!value && fallback) return *fallback;
  if (!value) fail_field(place, key, "is missing");
  const auto number = whole_number(*value);
  if (!number) fail_field(place, key, "is not a whole number");
  if (*number < least || *number > most)
    fail_field(place, key,
               "is " + std::to_string(*number) + ", outside " + std::to_string(least) + " to " +
                   std::to_string(most));
  return *number;
}

int64_t checked_integer(const json& object, const char* key, int64_t fallback) {
  const json* value = member(object, key);
  return value ? value->get<int64_t>() : fallback;
}

int64_t as_reference(const json& value, const char* key, const Place& place, int64_t count) {
  const auto number = whole_number(value);
  if (!number) fail_field(place, key, "is not a whole number");
  if (*number < 0 || *number >= count)
    fail_field(place, key, "refers to element " + std::to_string(*number) + " of " + std::to_string(count));
  return *number;
}

int64_t reference(const json& object, const char* key, const Place& place, int64_t count, bool required) {
  const json* value = member(object, key);
  if (!value && required) fail_field(place, key, "is missing");
  return value ? as_reference(*value, key, place, count) : -1;
}

const json* array(const json& object, const char* key, const Place& place) {
  return of_kind(object, key, place, json::value_t::array, "an array");
}

const json* object(const json& object, const char* key, const Place& place) {
  return of_kind(object, key, place, json::value_t::object, "an object");
}

const std::string* text(const json& object, const char* key, const Place& place) {
  const json* value = of_kind(object, key, place, json::value_t::string, "a string");
  return value ? &value->get_ref<const std::string&>() : nullptr;
}

const json& list(const json& root, const char* key) {
  static const json no_entries = json::array();
  const json* found = member(root, key);
  return found ? *found : no_entries;
}

const json* extension(const json& element, const char* name) {
  const json* extensions = member(element, "extensions");
  return extensions ? member(*extensions, name) : nullptr;
}

}  // namespace focal
