// Limits, strictness and the promise that writing gives back what was read.
#include "gltf/json.h"

#include <doctest/doctest.h>

#include <string>

#include "base/error.h"
#include "gltf/document_edit.h"

using namespace focal;

namespace {

template <class Document = JsonDocument>
Status status_of(const std::string& text, const JsonLimits& limits = {}) {
  try {
    Document document(std::as_bytes(std::span(text)), limits);
    return Status::ok;
  } catch (const Error& error) {
    CHECK_FALSE(error.hint().empty());
    return error.status();
  }
}

std::string nested(int depth) { return std::string(size_t(depth), '[') + std::string(size_t(depth), ']'); }

}  // namespace

TEST_CASE("depth and size are limited, and the limits are exact") {
  CHECK(status_of(nested(64)) == Status::ok);
  CHECK(status_of(nested(65)) == Status::unsupported);
  CHECK(status_of(nested(1'000'000)) == Status::unsupported);
  CHECK(status_of(std::string(1'000'000, '[')) == Status::unsupported);
  CHECK(status_of("[1,2,3]", {.depth = 64, .values = 4}) == Status::ok);
  CHECK(status_of("[1,2,3]", {.depth = 64, .values = 3}) == Status::unsupported);
}

TEST_CASE("what is no JSON is refused") {
  for (const char* text : {"", " ", "{", "[1,]", "{\"a\":1,}", "{\"a\":1,\"a\":2}", "[1] x", "[NaN]",
                           "[1e999]", "[\"\xff\"]", "\xEF\xBB\xBF[]", "// c\n[]", "[01]", "['a']"}) {
    CAPTURE(text);
    CHECK(status_of(text) == Status::invalid_file);
  }
}

TEST_CASE("a byte order mark is named") {
  for (const std::string text : {"\xEF\xBB\xBF", "\xEF\xBB\xBF[]"}) try {
      JsonDocument document(std::as_bytes(std::span(text)), {});
      FAIL("it was read");
    } catch (const Error& error) {
      CHECK(std::string(error.what()).find("byte order mark") != std::string::npos);
    }
}

TEST_CASE("an ordered document is written as it was read") {
  const std::string text =
      R"({"z":null,"a":[18446744073709551615,-9223372036854775808,1.0,0.1,1e-300],"":{"y":{},"x":[]},"u":"\u0001é","b":true})";
  OrderedJsonDocument document(std::as_bytes(std::span(text)), {});
  CHECK(document.root().dump() == text);
}

TEST_CASE("a member is taken out, and the others stay in their order") {
  const std::string text = R"({"a":{"b":[1,{"c":2}]},"a key longer than any short string":3,"d":"text"})";
  OrderedJsonDocument document(std::as_bytes(std::span(text)), {});
  CHECK_FALSE(remove(document.root(), "none"));
  CHECK(remove(document.root(), "a"));
  CHECK(document.root().dump() == R"({"a key longer than any short string":3,"d":"text"})");
  CHECK(is_text(document.root()["d"], "text"));
  CHECK_FALSE(is_text(document.root()["d"], "tex"));
  CHECK_FALSE(is_text(document.root()["a key longer than any short string"], "3"));
}
