// Every bound that a glTF file is checked against, exactly: the last value that is allowed is read, the next one is refused, by the
// check that is meant to.
#include <doctest/doctest.h>

#include <string>

#include "base/error.h"
#include "gltf/gltf_builder.h"
#include "gltf/one_call.h"

using namespace focal;
using namespace focal_test;

namespace {

struct Change {
  const char* place;    // JSON pointer
  json value;           // discarded: the member is left out
  const char* message;  // part of the error; "": it is read
};

std::string error_after(const GltfBuilder& file, const Change& change) {
  json root = file.root;
  const json::json_pointer place(change.place);
  if (change.value.is_discarded())
    root[place.parent_pointer()].erase(place.back());
  else
    root[place] = change.value;
  return error_of(glb_bytes(root.dump(), bin_chunk(file.bin)));
}

}  // namespace

TEST_CASE("one step beyond each bound is refused, the bound itself is not") {
  const GltfBuilder file = rich_file();
  const auto bytes = static_cast<int64_t>(file.bin.size());
  REQUIRE(error_of(glb_bytes(file.root.dump(), bin_chunk(file.bin))) == "");
  const json absent(json::value_t::discarded);
  const std::vector<Change> changes = {
      {"/buffers/0/byteLength", 0, "buffers[0].byteLength is 0, outside 1"},
      {"/buffers/0/byteLength", bytes - 1, "reaches beyond its buffer"},
      {"/buffers/0/byteLength", bytes + 1, "but the buffer has"},
      {"/buffers/0/uri", 1, "buffers[0].uri is not"},
      {"/bufferViews/0/buffer", 1, "refers to element 1 of 1"},
      {"/bufferViews/0/buffer", -1, "refers to element -1 of 1"},
      {"/bufferViews/0/buffer", absent, "bufferViews[0].buffer is missing"},
      {"/bufferViews/0", {{"buffer", 0}, {"byteLength", bytes}}, ""},
      {"/bufferViews/0", {{"buffer", 0}, {"byteLength", bytes + 1}}, "reaches beyond its buffer"},
      {"/bufferViews/0/byteOffset", -1, "bufferViews[0].byteOffset is -1, outside 0"},
      {"/bufferViews/0/byteOffset", bytes - 48, ""},
      {"/bufferViews/0/byteOffset", bytes - 47, "bufferViews[0].byteLength reaches beyond its buffer"},
      {"/bufferViews/0/byteLength", 0, "bufferViews[0].byteLength is 0, outside 1"},
      {"/bufferViews/0/byteLength", 47, "accessors[0].count is 4, reaching beyond its buffer view"},
      {"/bufferViews/0/byteStride", 3, "byteStride is 3, outside 4"},
      {"/bufferViews/0/byteStride", 4, "has a stride smaller than an element"},
      {"/bufferViews/0/byteStride", 11, "has a stride smaller than an element"},
      {"/bufferViews/0/byteStride", 12, ""},
      {"/bufferViews/0/byteStride", 13, "reaching beyond its buffer view"},
      {"/bufferViews/0/byteStride", 252, "reaching beyond its buffer view"},
      {"/bufferViews/0/byteStride", 253, "byteStride is 253, outside 4 to 252"},
      {"/accessors/0/count", 0, "accessors[0].count is 0: the accessor is empty"},
      {"/accessors/0/count", 5, "accessors[0].count is 5, reaching beyond its buffer view"},
      {"/accessors/0/count", 9007199254740992.0, "count is 9007199254740992, outside 0"},
      {"/accessors/0/count", 9007199254740994.0, "accessors[0].count is not a whole number"},
      {"/accessors/0/count", uint64_t{1} << 63, "accessors[0].count is not a whole number"},
      {"/accessors/0/count", 3.5, "accessors[0].count is not a whole number"},
      {"/accessors/0/byteOffset", -1, "accessors[0].byteOffset is -1, outside 0"},
      {"/accessors/0/byteOffset", 1, "reaching beyond its buffer view"},
      {"/accessors/0/bufferView", absent, ""},
      {"/accessors/0",
       {{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}, {"byteOffset", 0}},
       "without a bufferView"},
      {"/accessors/0/bufferView", 5, "refers to element 5 of 5"},
      {"/accessors/0/componentType", 5119, "componentType is 5119, outside 5120 to 5126"},
      {"/accessors/0/componentType", 5124, "is not a component type of glTF"},
      {"/accessors/0/componentType", 5127, "componentType is 5127, outside 5120 to 5126"},
      {"/accessors/0/normalized", 1, "normalized is not a boolean"},
      {"/accessors/0/type", "VEC5", "is missing or not a type of glTF"},
      {"/accessors/0/type", "VEC2", "is not a VEC3"},
      {"/accessors/1/componentType", 5120, "indices is not a scalar of unsigned integers"},
      {"/accessors/1/normalized", true, "indices is not a scalar of unsigned integers"},
      {"/accessors/0/sparse/count", 0, "count is 0, outside 1 to 4"},
      {"/accessors/0/sparse/count", 3, "count is 3, reaching beyond its buffer view"},
      {"/accessors/0/sparse/count", 5, "count is 5, outside 1 to 4"},
      {"/accessors/0/sparse/indices", nullptr, "indices is not an object"},
      {"/accessors/0/sparse/indices/componentType", 5120, "componentType is 5120, outside 5121 to 5125"},
      {"/accessors/0/sparse/indices/componentType", 5122, "has indices of an unsupported type"},
      {"/accessors/0/sparse/indices/componentType", 5123, "reaching beyond its buffer view"},
      {"/accessors/0/sparse/indices/componentType", 5125, "reaching beyond its buffer view"},
      {"/accessors/0/sparse/indices/componentType", 5126, "componentType is 5126, outside 5121 to 5125"},
      {"/accessors/0/sparse/indices/byteOffset", -1, "byteOffset is -1, outside 0"},
      {"/accessors/0/sparse/values/byteOffset", 1, "reaching beyond its buffer view"},
      {"/meshes/0/primitives", json::array(), "primitives is missing or empty"},
      {"/meshes/0/primitives/0", 1, "primitives contains something other than objects"},
      {"/meshes/0/primitives/0/attributes/POSITION", 3, "refers to element 3 of 3"},
      {"/meshes/0/primitives/0/attributes/NORMAL", 1,
       "has another number of entries than the other attributes"},
      {"/meshes/0/primitives/0/indices", 3, "refers to element 3 of 3"},
      {"/meshes/0/primitives/0/indices", 0, "indices is not a scalar of unsigned integers"},
      {"/meshes/0/primitives/0/mode", -1, "mode is -1, outside 0 to 6"},
      {"/meshes/0/primitives/0/mode", 0, "no triangles"},
      {"/meshes/0/primitives/0/mode", 6, ""},
      {"/meshes/0/primitives/0/mode", 7, "mode is 7, outside 0 to 6"},
      {"/meshes/0/primitives/0/targets/0", 1, "targets contains something other than objects"},
      {"/meshes/0/primitives/0/targets/0/POSITION", 1,
       "has another number of entries than the other attributes"},
      {"/nodes/0", 1, "nodes[0]. is not an object"},
      {"/nodes/0/mesh", 1, "refers to element 1 of 1"},
      {"/nodes/0/skin", 1, "refers to element 1 of 1"},
      {"/nodes/1/children/0", 3, "refers to element 3 of 3"},
      {"/nodes/1/children/0", 1, "children form a cycle"},
      {"/nodes/1/children/0", 0, ""},
      {"/nodes/0/children", {2}, "names a node that has a parent already"},
      {"/nodes/1/translation", {0, 0}, "translation is not 3 numbers"},
      {"/nodes/1/rotation", {0, 0, 0, "1"}, "rotation is not 4 numbers"},
      {"/nodes/1/scale", {1, 1, 1, 1}, "scale is not 3 numbers"},
      {"/nodes/2/matrix", {1, 2}, "matrix is not 16 numbers"},
      {"/scenes/0/nodes/0", 3, "refers to element 3 of 3"},
      {"/scene", 1, "refers to element 1 of 1"},
      {"/scene", 1.5, "scene is not a whole number"},
      {"/skins/0/joints", json::array(), "joints is missing or empty"},
      {"/skins/0/joints", {0, 1, 2, 0}, "joints names a node twice"},
      {"/skins/0/joints", {0, 1}, "has fewer matrices than there are joints"},
      {"/skins/0", {{"joints", {0, 1, 2}}}, ""},
      {"/skins/0/joints/0", 3, "refers to element 3 of 3"},
      {"/skins/0/inverseBindMatrices", 0, "is not a MAT4 of floats"},
      {"/asset/version", "3.0", "glTF version"},
      {"/asset/version", "0.9", "glTF version 0.9"},
      {"/asset/version", "2", "is missing or malformed"},
      {"/asset/version", "2.x", "is missing or malformed"},
      {"/asset/minVersion", "2.0", ""},
      {"/asset/minVersion", "2.1", "glTF version"},
      {"/asset", absent, "asset is missing"},
      {"/extensionsRequired", {1}, "contains something other than names"},
  };
  for (const Change& change : changes) {
    CAPTURE(std::string(change.place));
    CAPTURE(change.value.dump());
    const std::string error = error_after(file, change);
    CAPTURE(error);
    CHECK((*change.message ? error.find(change.message) != std::string::npos : error.empty()));
  }
}

TEST_CASE("an entry that a sparse accessor replaces exists") {
  for (const uint8_t last : {uint8_t{3}, uint8_t{4}}) {
    GltfBuilder file = rich_file();
    const auto at = file.root["bufferViews"][2]["byteOffset"].get<size_t>();
    file.bin[at + 1] = std::byte{last};
    const std::string error = error_of(glb_bytes(file.root.dump(), bin_chunk(file.bin)));
    CHECK((last == 3 ? error.empty()
                     : error.find("replaces an entry that does not exist") != std::string::npos));
  }
}

TEST_CASE("a file may be as large as its limits, and no larger") {
  const GltfBuilder file = rich_file();
  const std::string text = file.root.dump();
  const auto bytes = glb_bytes(text, bin_chunk(file.bin));
  const auto padded = static_cast<int64_t>((text.size() + 3) / 4 * 4);
  const auto check = [&](auto GltfLimits::*limit, int64_t needed) {
    GltfLimits limits;
    limits.*limit = static_cast<std::remove_reference_t<decltype(limits.*limit)>>(needed);
    CHECK(error_of(bytes, limits) == "");
    limits.*limit -= 1;
    CHECK(error_of(bytes, limits) != "");
  };
  check(&GltfLimits::vertices, 4);
  check(&GltfLimits::triangles, 4);
  check(&GltfLimits::nodes, 5);  // as many views as that
  check(&GltfLimits::json_bytes, padded);
}

TEST_CASE("primitives and matrices of skins are as many as there may be nodes, and no more") {
  GltfBuilder file = rich_file();
  for (int i = 0; i < 5; ++i)
    file.root["meshes"][0]["primitives"].push_back(file.root["meshes"][0]["primitives"][0]);
  CHECK(error_of(file.glb(), {.nodes = 6}) == "");
  CHECK(error_of(file.glb(), {.nodes = 5}).find("glTF with 6 primitives of a mesh") != std::string::npos);
  file = rich_file();
  file.root["skins"][0]["inverseBindMatrices"] = file.add_accessor(std::vector<float>(4 * 16, 1), "MAT4");
  file.add("skins", file.root["skins"][0]);
  CHECK(error_of(file.glb(), {.nodes = 8}) == "");
  CHECK(error_of(file.glb(), {.nodes = 7}).find("glTF with 8 skin matrices") != std::string::npos);
}

TEST_CASE("JSON that is no glTF is said to be so") {
  CHECK(error_of(bytes_of("[]")).find("not glTF") != std::string::npos);
  CHECK(error_of(bytes_of("3")).find("not glTF") != std::string::npos);
}

TEST_CASE("headers and chunks of a .glb are taken at their word only as far as the file goes") {
  const GltfBuilder file = rich_file();
  const auto whole = glb_bytes(file.root.dump(), bin_chunk(file.bin));
  const auto with = [&](size_t at, uint32_t value, size_t size) {
    auto bytes = whole;
    for (int i = 0; i < 4; ++i) bytes[at + i] = std::byte(value >> (8 * i));
    bytes.resize(size);
    return error_of(bytes);
  };
  const auto size = static_cast<uint32_t>(whole.size());
  const auto contains = [](const std::string& error, const char* part) {
    CAPTURE(error);
    CHECK(error.find(part) != std::string::npos);
  };
  CHECK(error_of({}).find("empty") != std::string::npos);
  contains(error_of(std::span(whole).first(11)), "the header is cut off");
  contains(with(8, 12, 12), "a chunk header is cut off");
  contains(with(4, 1, size), "GLB of version 1");
  contains(with(4, 3, size), "GLB of version 3");
  contains(with(8, 11, size), "the header announces 11 bytes");
  contains(with(8, 12, size), "a chunk header is cut off");
  contains(with(8, 19, size), "a chunk header is cut off");
  contains(with(8, size + 1, size), "the header announces");
  contains(with(8, size - 1, size), "a chunk of");
  contains(with(12, 0, size), "the first chunk is not JSON");
  contains(with(12, size - 20, size), "JSON");
  contains(with(12, size - 19, size), "bytes, but only");
  contains(with(16, 0x004e4942, size), "the first chunk is not JSON");
  const auto followed_by = [&](std::vector<std::byte> chunk) {
    auto bytes = whole;
    bytes.insert(bytes.end(), chunk.begin(), chunk.end());
    for (int i = 0; i < 4; ++i) bytes[8 + i] = std::byte(static_cast<uint32_t>(bytes.size()) >> (8 * i));
    return error_of(bytes);
  };
  const auto text = [](const char* letters) { return bytes_of(std::string(letters, 8)); };
  CHECK(followed_by(text("\0\0\0\0MINE")) == "");  // an empty one of another kind
  contains(followed_by(text("\0\0\0\0JSON")), "two JSON chunks");
  contains(followed_by(text("\1\0\0\0MINE")), "a chunk of 1 bytes, but only 0 are left");
  auto twice = whole;
  const auto json_end = static_cast<size_t>(20 + (file.root.dump().size() + 3) / 4 * 4);
  twice.insert(twice.end(), whole.begin() + static_cast<ptrdiff_t>(json_end), whole.end());
  for (int i = 0; i < 4; ++i) twice[8 + i] = std::byte(static_cast<uint32_t>(twice.size()) >> (8 * i));
  contains(error_of(twice), "two BIN chunks");
}
