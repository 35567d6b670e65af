// Base64 (RFC 4648's own vectors), percent escapes, and text made safe for messages.
#include "gltf/text.h"

#include <doctest/doctest.h>

using namespace focal;

namespace {

std::optional<std::string> decoded(const std::string& base64) {
  const auto bytes = data_uri_bytes("data:application/octet-stream;base64," + base64);
  if (!bytes) return std::nullopt;
  return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

}  // namespace

TEST_CASE("base64 gives RFC 4648's test vectors") {
  CHECK(decoded("") == "");
  CHECK(decoded("Zg==") == "f");
  CHECK(decoded("Zm8=") == "fo");
  CHECK(decoded("Zm9v") == "foo");
  CHECK(decoded("Zm9vYg==") == "foob");
  CHECK(decoded("Zm9vYmE=") == "fooba");
  CHECK(decoded("Zm9vYmFy") == "foobar");
  CHECK(decoded("Zm9vYg") == "foob");  // padding left out
  CHECK(decoded("+/+/") == "\xfb\xff\xbf");
}

TEST_CASE("malformed data URIs are refused") {
  CHECK_FALSE(decoded("Z"));
  CHECK_FALSE(decoded("Zm9v!"));
  CHECK_FALSE(decoded("Z=9v"));
  CHECK_FALSE(decoded("Zm9v===="));
  CHECK_FALSE(data_uri_bytes("data:text/plain,hello"));
  CHECK_FALSE(data_uri_bytes("file.bin"));
  CHECK_FALSE(data_uri_bytes("x:;base64,Zg=="));
  CHECK_FALSE(data_uri_bytes("data:,AAAA"));
}

TEST_CASE("percent escapes") {
  CHECK(percent_decoded("a%20b%2Fc") == "a b/c");
  CHECK(percent_decoded("%2F") == "/");
  // What begins no escape stays: exporters write file names as they are.
  CHECK(percent_decoded("a%2") == "a%2");
  CHECK(percent_decoded(std::string_view("a%2F").substr(0, 3)) == "a%2");
  CHECK(percent_decoded("%zz 10%") == "%zz 10%");
}

TEST_CASE("messages stay short and printable") {
  CHECK(printable("a\nb\x1b\xff") == "a?b??");
  CHECK(printable(std::string(100'000, 'x')).size() < 300);
}
