// Damaged files: every truncation, thousands of flipped bytes and edited numbers, and the collected corpora. Each
// must be refused with a specific status and a hint, or be read harmlessly, in under a second.
#include <doctest/doctest.h>

#include <ctime>
#include <map>

#include "base/error.h"
#include "base/random.h"
#include "evaluation_data.h"
#include "gltf/gltf_builder.h"
#include "gltf/preflight.h"
#include "gltf/reader.h"
#include "gltf/writer.h"

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
    std::cout << title << ": " << count(Status::ok) << " read, " << count(Status::invalid_file)
              << " invalid file, " << count(Status::invalid_mesh) << " invalid mesh, "
              << count(Status::unsupported) << " unsupported, " << count(Status::file_not_found)
              << " file not found; slowest " << slowest_ << " s\n";
  }

 private:
  std::map<Status, int64_t> counts_;
  double slowest_ = 0;
};

// A file with all that the reader looks at: two nodes, a skin, a sparse accessor.
std::vector<std::byte> rich_glb() {
  GltfBuilder file = tetrahedron();
  const int where = file.add_view(std::vector<uint8_t>{1, 3});
  const int what = file.add_view(std::vector<float>{5, 6, 7, 8, 9, 10});
  file.root["accessors"][0]["sparse"] = {{"count", 2},
                                         {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", what}}}};
  const int matrix =
      file.add_accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4");
  file.add_mesh(0, -1, 5);
  const int joint = file.add_node({{"rotation", {0, 0, 0, 1}}});
  file.add_node({{"mesh", 1}, {"skin", 0}}, joint);
  file.add("skins", {{"joints", {joint}}, {"inverseBindMatrices", matrix}});
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
  tally.report("truncations");
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
  tally.report("flipped bytes");
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
  tally.report("replaced numbers");
}

TEST_CASE("the collected invalid files are refused or read harmlessly") {
  if (!has_corpora()) return;
  for (const bool external : {false, true}) {
    Tally tally;
    read_folder("gltf_invalid", tally, {.limits = {}, .allow_external_files = external});
    tally.report(external ? "gltf_invalid, external files allowed" : "gltf_invalid");
    CHECK(tally.count(Status::ok) <=
          12);  // faults in what the reader does not look at: materials, colours, names
  }
}

TEST_CASE("the collected valid files are read, or hold nothing to read") {
  if (!has_corpora()) return;
  Tally tally;
  read_folder("gltf_valid", tally, {.limits = {}, .allow_external_files = true});
  tally.report("gltf_valid");
  CHECK(tally.count(Status::invalid_file) <= 3);  // buffers that are promised and not there
  CHECK(tally.count(Status::unsupported) == 0);
}
