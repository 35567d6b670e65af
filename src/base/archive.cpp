// Focal's file container: writes explicit little-endian bytes and checks everything it reads.
#include "base/archive.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/crc32c.h"
#include "base/error.h"

namespace focal {
namespace {

constexpr uint32_t endian_mark = 0x01020304;  // stored in the file as 04 03 02 01
constexpr size_t header_size = 32, entry_size = 24, name_size = 4;
constexpr size_t version_end = 16;  // magic, endian mark, major, minor: at the same offset in all versions
constexpr size_t checksum_at = 28;  // of the header before it and the table after it
constexpr uint32_t section_limit = 1024;

[[noreturn]] void refuse(const std::string& message) {
  throw Error(Status::invalid_file, message,
              "The file is corrupt or was not written by focal: save it again.");
}

uint32_t header_checksum(std::span<const std::byte> header_and_table) {
  const uint32_t crc = crc32c(header_and_table.first(checksum_at));
  return crc32c(header_and_table.subspan(header_size), crc);
}

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

int bits_for(uint32_t largest) { return std::max(1, static_cast<int>(std::bit_width(largest))); }

void ByteWriter::append(uint64_t value, int byte_count) {
  for (int i = 0; i < byte_count; ++i) bytes_.push_back(std::byte(value >> (8 * i) & 0xFF));
}

void ByteWriter::f32(float value) { u32(std::bit_cast<uint32_t>(value)); }
void ByteWriter::f64(double value) { u64(std::bit_cast<uint64_t>(value)); }

void ByteWriter::f32s(std::span<const float> values) {
  for (const float value : values) f32(value);
}

void ByteWriter::text(std::string_view value) {
  u32(static_cast<uint32_t>(value.size()));
  raw(bytes_of(value));
}

void ByteWriter::packed(std::span<const uint32_t> values, int bits) {
  uint64_t pending = 0;
  int pending_bits = 0;
  for (const uint32_t value : values) {
    pending |= uint64_t(value) << pending_bits;
    for (pending_bits += bits; pending_bits >= 8; pending_bits -= 8, pending >>= 8) u8(pending & 0xFF);
  }
  if (pending_bits > 0) u8(pending & 0xFF);
}

void ByteReader::fail(const std::string& problem) const { refuse(where_ + ": " + problem); }

std::span<const std::byte> ByteReader::raw(const char* what, size_t size) {
  if (size > rest_.size()) fail(std::string(what) + " runs past the end");
  const auto taken = rest_.first(size);
  rest_ = rest_.subspan(size);
  return taken;
}

uint64_t ByteReader::extract(int byte_count, const char* what) {
  const auto bytes = raw(what, static_cast<size_t>(byte_count));
  uint64_t value = 0;
  for (size_t i = 0; i < bytes.size(); ++i) value |= uint64_t(bytes[i]) << (8 * i);
  return value;
}

int32_t ByteReader::i32(const char* what, int32_t least, int32_t most) {
  const auto value = static_cast<int32_t>(u32(what));
  if (value < least || value > most) fail(std::string(what) + " is out of range");
  return value;
}

float ByteReader::f32(const char* what, float least, float most) {
  const auto value = std::bit_cast<float>(u32(what));
  if (!(value >= least && value <= most)) fail(std::string(what) + " is not a number of its range");
  return value;
}

double ByteReader::f64(const char* what, double least, double most) {
  const auto value = std::bit_cast<double>(u64(what));
  if (!(value >= least && value <= most)) fail(std::string(what) + " is not a number of its range");
  return value;
}

std::vector<float> ByteReader::f32s(const char* what, size_t count, float least, float most) {
  if (count > rest_.size() / 4) fail(std::string(what) + " runs past the end");
  std::vector<float> values(count);
  for (float& value : values) value = f32(what, least, most);
  return values;
}

int32_t ByteReader::count(const char* what, uint64_t item_bits, int32_t least, int32_t most) {
  const int32_t value = i32(what, least, most);
  if (value > 0 && item_bits > uint64_t(rest_.size()) * 8 / static_cast<uint64_t>(value))
    fail(std::string(what) + " is larger than the section");
  return value;
}

std::string ByteReader::text(const char* what) {
  const int32_t size = i32(what, 0, std::numeric_limits<int32_t>::max());
  return text_of(raw(what, static_cast<size_t>(size)));
}

std::vector<uint32_t> ByteReader::packed(const char* what, size_t count, int bits, uint32_t most) {
  if (count > rest_.size() * 8 / static_cast<size_t>(bits)) fail(std::string(what) + " runs past the end");
  const auto bytes = raw(what, (count * static_cast<size_t>(bits) + 7) / 8);
  std::vector<uint32_t> values(count);
  const uint64_t mask = (uint64_t(1) << bits) - 1;
  uint64_t pending = 0;
  int pending_bits = 0;
  size_t next = 0;
  for (uint32_t& value : values) {
    for (; pending_bits < bits; pending_bits += 8) pending |= uint64_t(bytes[next++]) << pending_bits;
    value = static_cast<uint32_t>(pending & mask);
    if (value > most) fail(std::string(what) + " is out of range");
    pending >>= bits, pending_bits -= bits;
  }
  return values;
}

void ByteReader::expect_end() const {
  if (!rest_.empty()) fail(std::to_string(rest_.size()) + " bytes too many");
}

std::vector<std::byte> write_archive(const ArchiveKind& kind, std::span<const ArchiveSection> sections) {
  ByteWriter table;
  uint64_t offset = header_size + entry_size * sections.size();
  for (const ArchiveSection& section : sections) {
    table.raw(bytes_of(section.name).first(name_size));
    table.u32(crc32c(section.bytes));
    table.u64(offset);
    table.u64(section.bytes.size());
    offset += section.bytes.size();
  }
  ByteWriter header;
  header.raw(bytes_of(kind.magic));
  header.u32(endian_mark);
  header.u16(kind.major_version);
  header.u16(kind.minor_version);
  header.u64(offset);
  header.u32(static_cast<uint32_t>(sections.size()));
  std::vector<std::byte> file = header.take();
  const std::vector<std::byte> table_bytes = table.take();
  ByteWriter checksum;
  checksum.u32(crc32c(table_bytes, crc32c(file)));
  const auto append = [&file](std::span<const std::byte> bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
  };
  file.reserve(offset);
  append(checksum.take());
  append(table_bytes);
  for (const ArchiveSection& section : sections) append(section.bytes);
  return file;
}

Archive::Archive(const ArchiveKind& kind, std::span<const std::byte> file) : kind_name_(kind.name) {
  const std::string name(kind.name);
  if (file.size() < version_end || text_of(file.first(kind.magic.size())) != kind.magic)
    refuse("This is not a focal " + name + " file");
  ByteReader header(file.subspan(kind.magic.size()), name + " header");
  if (header.u32("endian mark") != endian_mark) header.fail("wrong endian mark");
  const uint16_t major = header.u16("version");
  header.u16("minor version");
  if (major == 0 || major > kind.major_version)
    throw Error(Status::unsupported_version,
                "The " + name + " file has format version " + std::to_string(major) +
                    ", this library reads up to " + std::to_string(kind.major_version),
                "Update focal, or save the " + name + " again with this version.");
  const uint64_t size = header.u64("size");
  const uint32_t section_count = header.u32("section count");
  if (size > file.size()) refuse("The " + name + " file is truncated");
  if (size < file.size()) refuse("The " + name + " file has bytes after its end");
  read_table(file, section_count);
}

void Archive::read_table(std::span<const std::byte> file, uint32_t section_count) {
  const std::string header_name = kind_name_ + " header";
  const uint64_t table_end = header_size + uint64_t(section_count) * entry_size;
  if (section_count > section_limit || table_end > file.size()) refuse(header_name + ": bad section count");
  const auto header_and_table = file.first(table_end);
  ByteReader checksum(header_and_table.subspan(checksum_at), header_name);
  if (checksum.u32("checksum") != header_checksum(header_and_table)) refuse(header_name + ": wrong checksum");
  ByteReader table(header_and_table.subspan(header_size), header_name);
  uint64_t end = table_end;  // sections are contiguous: no bytes without a checksum
  for (uint32_t i = 0; i < section_count; ++i) {
    const std::string name = text_of(table.raw("section name", name_size));
    const std::string where = kind_name_ + " section " + name;
    const uint32_t crc = table.u32("checksum");
    const uint64_t offset = table.u64("offset"), size = table.u64("size");
    if (offset != end || size > file.size() - end) refuse(where + ": bad place in the file");
    end += size;
    const auto bytes = file.subspan(offset, size);
    if (crc32c(bytes) != crc) refuse(where + ": wrong checksum");
    if (has(name)) refuse(where + ": there twice");
    entries_.push_back({name, bytes});
  }
  if (end != file.size()) refuse(header_name + ": the sections do not fill the file");
}

const Archive::Entry* Archive::find(std::string_view name) const {
  const auto at =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.name == name; });
  return at == entries_.end() ? nullptr : &*at;
}

bool Archive::has(std::string_view name) const { return find(name) != nullptr; }

ByteReader Archive::section(std::string_view name) const {
  const std::string where = kind_name_ + " section " + std::string(name);
  const Entry* entry = find(name);
  if (!entry) refuse(where + ": missing");
  return {entry->bytes, where};
}

}  // namespace focal
