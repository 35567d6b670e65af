// Damaged files: every truncation, thousands of flipped bytes, every value of the JSON replaced by the worst ones, headers that lie, and
// the collected corpora. Each must be refused with a specific status and a hint, or be read harmlessly, in under a second; the
// last case tells how many there were.
#include <doctest/doctest.h>

#include <ctime>
#include <map>
#include <set>

#include "base/error.h"
#include "base/random.h"
#include "evaluation_data.h"
#include "gltf/document.h"
#include "gltf/gltf_builder.h"
#include "gltf/one_call.h"
#include "gltf/preflight.h"

using namespace focal;
using namespace focal_test;

namespace {

// What became of a number of files, by status.
class Tally {
 public:
  template <class Read>
  void add(Read&& read) {
    const std::clock_t start = std::clock();
    Status status = Status::ok;
    try {
      const GltfMesh mesh = read();
      const bool sound = mesh.mesh.positions.allFinite() && mesh.mesh.triangles.minCoeff() >= 0 &&
                         mesh.mesh.triangles.maxCoeff() < mesh.mesh.vertex_count();
      CHECK(sound);
    } catch (const Error& error) {
      status = error.status();
      const bool specific = status == Status::invalid_file || status == Status::invalid_mesh ||
                            status == Status::unsupported || status == Status::file_not_found;
      CHECK(specific);
      const bool explained = std::string(error.what()).size() > 10 && !error.hint().empty();
      CHECK(explained);
    }
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    slowest_ = std::max(slowest_, seconds);
    ++counts_[status];
  }
  int64_t count(Status status) const {
    const auto found = counts_.find(status);
    return found == counts_.end() ? 0 : found->second;
  }
  void report(const std::string& title) const {
    CHECK(slowest_ < 1);
    int64_t files = 0;
    for (const auto& [status, number] : counts_) files += number;
    std::cout << title << ": " << files << " files, " << count(Status::ok) << " read, "
              << count(Status::invalid_file) << " invalid file, " << count(Status::invalid_mesh)
              << " invalid mesh, " << count(Status::unsupported) << " unsupported, "
              << count(Status::file_not_found) << " file not found; slowest " << slowest_ << " s\n";
  }
  void add(const Tally& other) {
    for (const auto& [status, number] : other.counts_) counts_[status] += number;
    slowest_ = std::max(slowest_, other.slowest_);
  }

 private:
  std::map<Status, int64_t> counts_;
  double slowest_ = 0;
};

Tally& all_files() {
  static Tally tally;
  return tally;
}

void finish(const std::string& title, const Tally& tally) {
  tally.report(title);
  all_files().add(tally);
}

std::vector<std::byte> rich_glb() {
  GltfBuilder file = rich_file();
  file.add_mesh(0, -1, 5);
  file.add_node({{"mesh", 1}, {"skin", 0}}, 1);
  return file.glb();
}

void read_folder(const std::string& name, Tally& tally, GltfReadParams params) {
  const std::filesystem::path folder =
      std::filesystem::path(std::getenv("FOCAL_EVALUATION_DATA")) / "corpora" / name;
  const json index = read_json(folder / "index.json");
  for (const json& file : index["files"]) {
    CAPTURE(file["file"]);
    tally.add([&] { return read_gltf(folder / file["file"].get<std::string>(), params); });
  }
}

bool has_corpora() {
  const char* root = std::getenv("FOCAL_EVALUATION_DATA");
  if (root && std::filesystem::exists(std::filesystem::path(root) / "corpora" / "gltf_invalid")) return true;
  std::cout << "skipped: no corpora in FOCAL_EVALUATION_DATA\n";
  return false;
}

}  // namespace

TEST_CASE("every truncation of a file is refused") {
  const auto whole = rich_glb();
  REQUIRE(read_gltf_memory(whole).primitives.size() == 2);
  Tally tally;
  for (size_t length = 0; length < whole.size(); ++length)
    tally.add([&] { return read_gltf_memory(std::span(whole).first(length)); });
  finish("truncations", tally);
  CHECK(tally.count(Status::ok) == 0);
}

TEST_CASE("flipped bytes are harmless") {
  const auto whole = rich_glb();
  Random random(7);
  Tally tally;
  for (int round = 0; round < 3000; ++round) {
    auto bytes = whole;
    for (int flips = 1 + round % 3; flips > 0; --flips)
      bytes[random.below(static_cast<uint32_t>(bytes.size()))] ^= std::byte(1 + random.below(255));
    tally.add([&] { return read_gltf_memory(bytes); });
  }
  finish("flipped bytes", tally);
}

TEST_CASE("numbers replaced by the worst ones are harmless, when writing too") {
  const auto source = rich_glb();
  const GltfContainer parts = open_container(source, {});
  const std::string text(reinterpret_cast<const char*>(parts.json.data()), parts.json.size());
  const std::vector<std::string> worst = {"-1",  "0",    "1e308",    "4294967295", "18446744073709551615",
                                          "0.5", "null", "\"text\"", "[]",         "{}"};
  Tally tally;
  for (size_t at = 0; at < text.size(); ++at) {
    const auto is_digit = [&](size_t i) { return text[i] >= '0' && text[i] <= '9'; };
    if (!is_digit(at) || is_digit(at - 1)) continue;
    size_t end = at;
    while (is_digit(end)) ++end;
    for (const std::string& number : worst) {
      const auto bytes = glb_bytes(text.substr(0, at) + number + text.substr(end), parts.rest);
      tally.add([&] { return read_gltf_memory(bytes); });
      try {
        add_landmarks(bytes, {}, {});
      } catch (const Error& error) {
        CHECK(error.status() != Status::internal);
      }
    }
  }
  finish("replaced numbers", tally);
}

TEST_CASE("every value replaced by one of another kind, left out, or there twice") {
  const auto source = rich_glb();
  const GltfContainer parts = open_container(source, {});
  const std::string text(reinterpret_cast<const char*>(parts.json.data()), parts.json.size());
  const json root = json::parse(text);
  const std::string deep = std::string(200, '[') + std::string(200, ']');
  const std::vector<json> worst = {nullptr,
                                   true,
                                   -1,
                                   0.5,
                                   1e308,
                                   uint64_t{1} << 62,
                                   "text",
                                   "\u0000",
                                   json::array(),
                                   json::object(),
                                   json::array({-1, 1e300, "x"}),
                                   json::parse(deep)};
  Tally tally;
  const auto read = [&](const std::string& changed) {
    const auto bytes = glb_bytes(changed, parts.rest);
    tally.add([&] { return read_gltf_memory(bytes); });
  };
  std::set<std::string> places;
  const json flat = root.flatten();
  for (const auto& [pointer, value] : flat.items())
    for (json::json_pointer at(pointer); !at.empty(); at = at.parent_pointer()) places.insert(at.to_string());
  for (const std::string& place : places) {
    const json::json_pointer at(place);
    for (const json& other : worst) {
      json changed = root;
      changed[at] = other;
      read(changed.dump());
    }
    json without = root;
    if (json& parent = without[at.parent_pointer()]; parent.is_object()) {
      parent.erase(at.back());
      read(without.dump());
      const std::string entry = json(at.back()).dump() + ":" + root[at].dump();  // the same key twice
      if (const size_t found = text.find(entry); found != std::string::npos)
        read(text.substr(0, found) + entry + "," + text.substr(found));
    }
  }
  finish("replaced values", tally);
}

TEST_CASE("headers and chunks that lie about their length") {
  const auto whole = rich_glb();
  Tally tally;
  for (const size_t at : {0, 4, 8, 12, 16})
    for (const uint32_t value :
         {0u, 1u, 2u, 3u, 11u, 12u, 19u, 20u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFFF0u, 0xFFFFFFFFu})
      for (const size_t cut : {size_t{0}, size_t{1}, whole.size() / 2}) {
        auto bytes = whole;
        for (int i = 0; i < 4; ++i) bytes[at + i] = std::byte(value >> (8 * i));
        bytes.resize(bytes.size() - cut);
        tally.add([&] { return read_gltf_memory(bytes); });
      }
  finish("lying headers", tally);
}

TEST_CASE("JSON nested by tens of thousands, in every place") {
  const auto source = rich_glb();
  const GltfContainer parts = open_container(source, {});
  const std::string text(reinterpret_cast<const char*>(parts.json.data()), parts.json.size());
  Tally tally;
  for (const char* open : {"[", "{\"a\":", "[{\"a\":"})
    for (const int depth : {65, 1000, 40'000}) {
      std::string nested;
      for (int i = 0; i < depth; ++i) nested += open;
      for (const std::string& changed :
           {nested, text.substr(0, text.size() - 1) + ",\"extras\":" + nested,
            text.substr(0, text.size() - 1) + ",\"extensions\":{\"x\":" + nested}) {
        const auto bytes = glb_bytes(changed, parts.rest);
        tally.add([&] { return read_gltf_memory(bytes); });
      }
    }
  finish("deep nesting", tally);
  CHECK(tally.count(Status::ok) == 0);
}

TEST_CASE("the collected invalid files are refused or read harmlessly") {
  if (!has_corpora()) return;
  for (const bool external : {false, true}) {
    Tally tally;
    read_folder("gltf_invalid", tally, {.limits = {}, .allow_external_files = external});
    finish(external ? "gltf_invalid, external files allowed" : "gltf_invalid", tally);
    CHECK(tally.count(Status::ok) <=
          12);  // faults in what the reader does not look at: materials, colours, names
  }
}

TEST_CASE("the collected valid files are read, or hold nothing to read") {
  if (!has_corpora()) return;
  Tally tally;
  read_folder("gltf_valid", tally, {.limits = {}, .allow_external_files = true});
  finish("gltf_valid", tally);
  CHECK(tally.count(Status::invalid_file) <= 3);  // buffers that are promised and not there
  CHECK(tally.count(Status::unsupported) == 0);
}

TEST_CASE("all of them, in one line") {
  all_files().report("malformed glTF");
  CHECK(all_files().count(Status::invalid_file) > 2000);
  CHECK(all_files().count(Status::internal) == 0);
}
