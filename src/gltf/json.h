// JSON from untrusted bytes, held so that neither depth nor a failing allocation can end the process.
//
// nlohmann::json is used through its SAX parser, which is iterative, with the limits checked on every event.
// Its destructor allocates inside noexcept to flatten nested values; a JsonDocument takes its tree apart from
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
  // Throws invalid_file (syntax, UTF-8, a key given twice), unsupported (a limit exceeded).
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

// Whether a value is this text: nlohmann's own == makes a value of it, which may throw where nothing may.
template <class Json>
bool is_text(const Json& value, std::string_view text) {
  const auto* own = value.template get_ptr<const typename Json::string_t*>();
  return own && *own == text;
}

using JsonDocument = BasicJsonDocument<nlohmann::json>;
using OrderedJsonDocument =
    BasicJsonDocument<nlohmann::ordered_json>;  // keeps the order of keys, for writing

}  // namespace focal
