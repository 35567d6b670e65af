// The container: known checksums, round trips, and that no flipped bit or cut goes unseen.
#include "base/archive.h"

#include <doctest/doctest.h>

#include <limits>

#include "base/crc32c.h"
#include "base/error.h"

using namespace focal;

namespace {

constexpr ArchiveKind kind{"FOCALTST", "test", 2, 1};

std::vector<std::byte> small_archive() {
  ByteWriter numbers;
  numbers.u8(7);
  numbers.f64(-0.1);
  numbers.text("left_\xC3\xA9");
  const std::vector<uint32_t> ids = {0, 5, 4, 3, 2, 1, 5};
  numbers.packed(ids, bits_for(5));
  const std::vector<ArchiveSection> sections = {{"NUMB", numbers.take()}, {"NEWS", {std::byte(1)}}};
  return write_archive(kind, sections);
}

Status status_of(std::span<const std::byte> file) {
  try {
    Archive archive(kind, file);
    return Status::ok;
  } catch (const Error& error) {
    CHECK_FALSE(error.hint().empty());
    return error.status();
  }
}

}  // namespace

TEST_CASE("crc32c agrees with RFC 3720's test vectors") {
  std::vector<std::byte> bytes(32, std::byte(0));
  CHECK(crc32c(bytes) == 0x8A9136AA);
  std::fill(bytes.begin(), bytes.end(), std::byte(0xFF));
  CHECK(crc32c(bytes) == 0x62A8AB43);
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = std::byte(i);
  CHECK(crc32c(bytes) == 0x46DD794E);
  const std::span<const std::byte> all(bytes);
  CHECK(crc32c(all.subspan(13), crc32c(all.first(13))) == 0x46DD794E);
}

TEST_CASE("an archive gives back what was written and ignores sections it does not know") {
  const auto file = small_archive();
  const Archive archive(kind, file);
  ByteReader reader = archive.section("NUMB");
  CHECK(reader.u8("byte") == 7);
  CHECK(reader.f64("number") == -0.1);
  CHECK(reader.text("name") == "left_\xC3\xA9");
  CHECK(reader.packed("ids", 7, 3, 5) == std::vector<uint32_t>{0, 5, 4, 3, 2, 1, 5});
  reader.expect_end();
  CHECK(archive.has("NEWS"));
  CHECK_THROWS_AS(archive.section("GONE"), Error);
}

TEST_CASE("every flipped bit and every truncation of an archive is noticed") {
  const auto file = small_archive();
  REQUIRE(status_of(file) == Status::ok);
  for (size_t i = 0; i < file.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) {
      auto damaged = file;
      damaged[i] ^= std::byte(1 << bit);
      const bool minor_version = i == 14 || i == 15;  // readable, but still covered by the header's checksum
      const Status status = status_of(damaged);
      CHECK((status == Status::invalid_file || (status == Status::unsupported_version && !minor_version)));
    }
  for (size_t size = 0; size < file.size(); ++size)
    CHECK(status_of(std::span(file).first(size)) == Status::invalid_file);
  auto longer = file;
  longer.push_back(std::byte(0));
  CHECK(status_of(longer) == Status::invalid_file);
}

TEST_CASE("a newer major version is refused as such, a newer minor one is read") {
  ArchiveKind newer = kind;
  newer.minor_version = 9;
  CHECK(status_of(write_archive(newer, {})) == Status::ok);
  newer.major_version = 3;
  CHECK(status_of(write_archive(newer, {})) == Status::unsupported_version);
}

TEST_CASE("a reader believes no count, number or index") {
  ByteWriter writer;
  writer.u32(1000000);
  const auto bytes = writer.take();
  CHECK_THROWS_AS(ByteReader(bytes, "x").count("items", 8), Error);
  CHECK_THROWS_AS(ByteReader(bytes, "x").text("name"), Error);
  CHECK_THROWS_AS(ByteReader(bytes, "x").i32("index", 0, 999999), Error);
  CHECK_THROWS_AS(ByteReader(bytes, "x").packed("ids", size_t(1) << 62, 32, 5), Error);
  CHECK_THROWS_AS(ByteReader(bytes, "x").packed("ids", 8, 4, 0), Error);
  CHECK_THROWS_AS(ByteReader(bytes, "x").u64("number"), Error);
  CHECK_THROWS_AS(ByteReader(bytes, "x").expect_end(), Error);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1.5F}) {
    ByteWriter floats;
    floats.f32(bad);
    const auto float_bytes = floats.take();
    CHECK_THROWS_AS(ByteReader(float_bytes, "x").f32("number", 0, 1), Error);
  }
}
