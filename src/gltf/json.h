// Parses JSON from untrusted bytes and stores it so that neither depth nor a failing allocation can terminate
// the process.
//
// nlohmann::json is used through its SAX parser, which is iterative, with the limits checked on every event.
// Its destructor allocates inside noexcept to flatten nested values; a JsonDocument dismantles its tree from
// the leaves instead, which needs no memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <utility>

namespace focal {

struct JsonLimits {
  int32_t depth = 64;
  int64_t values = 4'000'000;
};

template <class Json>
class BasicJsonDocument {
 public:
  BasicJsonDocument() = default;  // null
  // Throws invalid_file (syntax, UTF-8, a duplicate key), unsupported (a limit exceeded).
  BasicJsonDocument(std::span<const std::byte> text, const JsonLimits& limits);
  BasicJsonDocument(BasicJsonDocument&& other) noexcept : root_(std::move(other.root_)) {}
  BasicJsonDocument& operator=(BasicJsonDocument&&) = delete;
  ~BasicJsonDocument() { dismantle(root_); }

  Json& root() { return root_; }
  const Json& root() const { return root_; }

 private:
  // Recursive, which the depth limit makes safe.
  static void dismantle(Json& value) noexcept;

  Json root_;
};

// Whether a value is this text: nlohmann's own == creates a value from the text, which may throw where
// nothing may throw.
template <class Json>
bool is_text(const Json& value, std::string_view text) {
  const auto* own = value.template get_ptr<const typename Json::string_t*>();
  return own && *own == text;
}

using JsonDocument = BasicJsonDocument<nlohmann::json>;
// Keeps the order of keys, for writing.
using OrderedJsonDocument = BasicJsonDocument<nlohmann::ordered_json>;

}  // namespace focal
