// Focal's file container: a header, a table of sections with a checksum each, then the sections. All numbers
// are little-endian on every machine. docs/model-format.md describes the bytes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace focal {

// A file type. A reader accepts files of its own major version and any minor version: a new minor version
// only adds sections, which older readers skip.
struct ArchiveKind {
  std::string_view magic;  // 8 characters
  std::string_view name;   // for messages: "model"
  uint16_t major_version = 1;
  uint16_t minor_version = 0;
};

// Appends numbers to the bytes of one section.
class ByteWriter {
 public:
  void u8(uint8_t value) { bytes_.push_back(std::byte(value)); }
  void u16(uint16_t value) { append(value, 2); }
  void u32(uint32_t value) { append(value, 4); }
  void u64(uint64_t value) { append(value, 8); }
  void i32(int32_t value) { append(static_cast<uint32_t>(value), 4); }
  void f32(float value);
  void f64(double value);
  void f32s(std::span<const float> values);
  void text(std::string_view value);  // u32 length, then UTF-8 bytes
  void raw(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  // Packs each value into `bits` bits (1..32), lowest bit first, and pads with zeros to a full byte.
  void packed(std::span<const uint32_t> values, int bits);
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void append(uint64_t value, int byte_count);
  std::vector<std::byte> bytes_;
};

// Reads what ByteWriter wrote and validates every value: one that is out of range, not finite or beyond the
// end throws Error{invalid_file} with the names of the section and of the value.
class ByteReader {
 public:
  ByteReader(std::span<const std::byte> bytes, std::string where) : rest_(bytes), where_(std::move(where)) {}

  uint8_t u8(const char* what) { return static_cast<uint8_t>(extract(1, what)); }
  uint16_t u16(const char* what) { return static_cast<uint16_t>(extract(2, what)); }
  uint32_t u32(const char* what) { return static_cast<uint32_t>(extract(4, what)); }
  uint64_t u64(const char* what) { return extract(8, what); }
  int32_t i32(const char* what, int32_t least, int32_t most);
  float f32(const char* what, float least = std::numeric_limits<float>::lowest(),
            float most = std::numeric_limits<float>::max());
  double f64(const char* what, double least = std::numeric_limits<double>::lowest(),
             double most = std::numeric_limits<double>::max());
  std::vector<float> f32s(const char* what, size_t count, float least, float most);
  // Reads a u32 number of items that take at least `item_bits` each. Use it where memory is allocated before
  // the items are read: the allocation cannot exceed the file's size.
  int32_t count(const char* what, uint64_t item_bits, int32_t least = 0,
                int32_t most = std::numeric_limits<int32_t>::max());
  std::string text(const char* what);
  std::span<const std::byte> raw(const char* what, size_t size);
  std::vector<uint32_t> packed(const char* what, size_t count, int bits, uint32_t most);
  void expect_end() const;

  [[noreturn]] void fail(const std::string& problem) const;

 private:
  uint64_t extract(int byte_count, const char* what);
  std::span<const std::byte> rest_;
  std::string where_;
};

// Number of bits that can hold every value of 0..largest, at least 1.
int bits_for(uint32_t largest);

// A section's name is four characters and unique in its file.
struct ArchiveSection {
  std::string name;
  std::vector<std::byte> bytes;
};

std::vector<std::byte> write_archive(const ArchiveKind& kind, std::span<const ArchiveSection> sections);

// Views into a file's bytes; the constructor checks the header, the table and every section's checksum.
class Archive {
 public:
  // Throws invalid_file (not of this kind, truncated, corrupt) and unsupported_version.
  Archive(const ArchiveKind& kind, std::span<const std::byte> file);
  bool has(std::string_view name) const;
  ByteReader section(std::string_view name) const;  // throws invalid_file when it is missing

 private:
  struct Entry {
    std::string name;
    std::span<const std::byte> bytes;
  };
  void read_table(std::span<const std::byte> file, uint32_t section_count);
  const Entry* find(std::string_view name) const;

  std::string kind_name_;
  std::vector<Entry> entries_;
};

}  // namespace focal
