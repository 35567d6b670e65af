// The container: known checksums, round trips, and that no flipped bit or cut goes unseen.
#include "base/archive.h"

#include <doctest/doctest.h>

#include <limits>

#include "base/crc32c.h"
#include "base/error.h"
#include "base/signed_archive.h"

using namespace focal;
using focal_test::put, focal_test::sign;

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

std::string archive_error_of(std::span<const std::byte> file) {
  try {
    Archive archive(kind, file);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

void check_archive_error(const std::string& error, const char* part) {
  CAPTURE(error);
  CHECK(error.find(part) != std::string::npos);
}

std::vector<std::byte> archive_of(int sections) {
  std::vector<ArchiveSection> all;
  for (int i = 0; i < sections; ++i) {
    std::string name(4, 'A');
    for (int k = 0; k < 3; ++k) name[static_cast<size_t>(k)] = static_cast<char>('A' + (i >> (4 * k) & 15));
    all.push_back({name, {}});
  }
  return write_archive(kind, all);
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

TEST_CASE("a range holds its bounds and nothing beyond") {
  ByteWriter writer;
  for (const float value : {0.0F, 1.0F, -0.5F, 1.5F}) writer.f32(value);
  for (const double value : {0.0, 1.0, -0.5, 1.5, std::numeric_limits<double>::quiet_NaN()})
    writer.f64(value);
  const auto bytes = writer.take();
  ByteReader reader(bytes, "x");
  CHECK(reader.f32("number", 0, 1) == 0);
  CHECK(reader.f32("number", 0, 1) == 1);
  CHECK_THROWS_AS(reader.f32("number", 0, 1), Error);
  CHECK_THROWS_AS(reader.f32("number", 0, 1), Error);
  CHECK(reader.f64("number", 0, 1) == 0);
  CHECK(reader.f64("number", 0, 1) == 1);
  CHECK_THROWS_AS(reader.f64("number", 0, 1), Error);
  CHECK_THROWS_AS(reader.f64("number", 0, 1), Error);
  CHECK_THROWS_AS(reader.f64("number", 0, 1), Error);
  reader.expect_end();
  CHECK_THROWS_AS(ByteReader(bytes, "x").f32s("numbers", size_t{1} << 60, -9, 9), Error);
  CHECK_THROWS_AS(ByteReader(bytes, "x").f32s("numbers", bytes.size() / 4 + 1, -9, 9), Error);
}

TEST_CASE("numbers of items are taken as far as the bytes go") {
  ByteWriter writer;
  for (const uint32_t value : {3u, 7u, 0u, 0u, UINT32_MAX})
    writer.u32(value);  // a count, and 16 bytes behind it
  const auto bytes = writer.take();
  const auto reader = [&](size_t at) { return ByteReader(std::span(bytes).subspan(at), "x"); };
  CHECK(reader(0).i32("number", 3, 3) == 3);
  CHECK(reader(16).i32("number", -1, 0) == -1);
  CHECK_THROWS_AS(reader(0).i32("number", 4, 5), Error);
  CHECK_THROWS_AS(reader(0).i32("number", 0, 2), Error);
  CHECK(reader(0).count("items", 128 / 3) == 3);
  CHECK_THROWS_AS(reader(0).count("items", 128 / 3 + 1), Error);
  CHECK(reader(8).count("items", 1000) == 0);
  CHECK(ByteReader(std::span(bytes).first(16), "x").f32s("numbers", 4, 0, 1).size() == 4);
  CHECK(reader(8).text("name") == "");
  CHECK_THROWS_WITH_AS(reader(16).text("name"), "x: name is out of range", Error);
  CHECK(reader(0).packed("ids", 20, 8, 255).size() == 20);
  CHECK_THROWS_AS(reader(0).packed("ids", 21, 8, 255), Error);
}

TEST_CASE("a file says why it is none") {
  const auto file = small_archive();
  check_archive_error(archive_error_of(std::span(file).first(15)), "This is not a focal test file");
  check_archive_error(archive_error_of(std::span(file).first(16)), "test header: size runs past the end");
  check_archive_error(archive_error_of(std::span(file).first(file.size() - 1)), "is truncated");
  auto longer = file;
  longer.push_back({});
  check_archive_error(archive_error_of(longer), "has bytes after its end");
}

TEST_CASE("as many sections as allowed, and no more than there are") {
  CHECK(archive_error_of(archive_of(1024)) == "");
  check_archive_error(archive_error_of(archive_of(1025)), "bad section count");
  auto file = small_archive();
  put(file, 24, 1024);
  check_archive_error(archive_error_of(file), "bad section count");
}

TEST_CASE("sections lie one after the other, each once, and fill the file") {
  const auto with = [](size_t at, uint32_t value) {
    auto file = small_archive();
    put(file, at, value);
    sign(file);
    return archive_error_of(file);
  };
  const auto file = small_archive();
  constexpr size_t first = 32, second = 56;  // entries: name, checksum, offset, size
  const auto size = static_cast<uint32_t>(focal_test::number_at(file, first + 16, 8));
  CHECK(with(first + 16, size) == "");
  check_archive_error(with(first + 8, 81), "section NUMB: bad place in the file");
  check_archive_error(with(first + 16, size - 1), "section NEWS: bad place in the file");
  check_archive_error(with(second + 16, 2), "section NEWS: bad place in the file");
  check_archive_error(with(second + 16, 0), "the sections do not fill the file");
  check_archive_error(with(second, 'N' | 'U' << 8 | 'M' << 16 | 'B' << 24), "section NUMB: there twice");
}
