// Small glTF documents made in the tests, in either container.
#pragma once
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "gltf/container.h"
#include "gltf/one_call.h"

namespace focal_test {

using nlohmann::json;

template <class T>
constexpr int component_type_of() {
  if constexpr (std::is_same_v<T, int8_t>) return 5120;
  if constexpr (std::is_same_v<T, uint8_t>) return 5121;
  if constexpr (std::is_same_v<T, int16_t>) return 5122;
  if constexpr (std::is_same_v<T, uint16_t>) return 5123;
  if constexpr (std::is_same_v<T, uint32_t>) return 5125;
  return 5126;
}

inline int components_of(const std::string& type) { return type == "VEC3" ? 3 : type == "MAT4" ? 16 : 1; }

struct GltfBuilder {
  json root = {{"asset", {{"version", "2.0"}}}};
  std::vector<std::byte> bin;

  int add(const char* list, json element) {
    root[list].push_back(std::move(element));
    return static_cast<int>(root[list].size()) - 1;
  }
  template <class T>
  int add_view(const std::vector<T>& values) {
    const size_t offset = bin.size(), size = values.size() * sizeof(T);
    bin.resize((offset + size + 3) / 4 * 4);
    std::memcpy(bin.data() + offset, values.data(), size);
    return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
  }
  template <class T>
  int add_accessor(const std::vector<T>& values, const std::string& type, bool normalized = false) {
    json accessor = {{"bufferView", add_view(values)},
                     {"componentType", component_type_of<T>()},
                     {"type", type},
                     {"count", values.size() / static_cast<size_t>(components_of(type))}};
    if (normalized) accessor["normalized"] = true;
    return add("accessors", accessor);
  }
  // A mesh of one primitive; indices -1 for none.
  int add_mesh(int positions, int indices = -1, int mode = 4) {
    json primitive = {{"attributes", {{"POSITION", positions}}}, {"mode", mode}};
    if (indices >= 0) primitive["indices"] = indices;
    return add("meshes", {{"primitives", json::array({primitive})}});
  }
  // A node in scene 0, or below another one.
  int add_node(json node, int parent = -1) {
    const int index = add("nodes", std::move(node));
    if (parent >= 0)
      root["nodes"][static_cast<size_t>(parent)]["children"].push_back(index);
    else
      root["scenes"][0]["nodes"].push_back(index);
    root["scene"] = 0;
    return index;
  }

  std::vector<std::byte> glb() const {
    json complete = root;
    if (!bin.empty()) complete["buffers"] = json::array({{{"byteLength", bin.size()}}});
    return focal::glb_bytes(complete.dump(), focal::bin_chunk(bin));
  }
  std::vector<std::byte> gltf(const std::string& uri) const {
    json complete = root;
    complete["buffers"] = json::array({{{"byteLength", bin.size()}, {"uri", uri}}});
    const std::string text = complete.dump(2);
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
  }
};

inline std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

// "" when it is read; a missing pattern shows the message that came instead.
inline std::string error_of(std::span<const std::byte> file, const focal::GltfLimits& limits = {}) {
  try {
    focal_test::read_gltf_memory(file, {.limits = limits});
    return "";
  } catch (const focal::Error& error) {
    return error.what();
  }
}

inline const std::vector<float> tetrahedron_corners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
inline const std::vector<uint16_t> tetrahedron_faces = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

inline GltfBuilder tetrahedron() {
  GltfBuilder file;
  const int positions = file.add_accessor(tetrahedron_corners, "VEC3");
  file.root["accessors"][0]["min"] = {0, 0, 0};
  file.root["accessors"][0]["max"] = {1, 1, 1};
  file.add_mesh(positions, file.add_accessor(tetrahedron_faces, "SCALAR"));
  file.add_node({{"mesh", 0}});
  return file;
}

// All that the reader looks at: nodes, a skin, a sparse accessor, a morph target; one buffer of exactly the bytes needed.
inline GltfBuilder rich_file() {
  GltfBuilder file = tetrahedron();
  const int where = file.add_view(std::vector<uint8_t>{1, 3});
  const int what = file.add_view(std::vector<float>{5, 6, 7, 8, 9, 10});
  file.root["accessors"][0]["sparse"] = {{"count", 2},
                                         {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", what}}}};
  const int matrix =
      file.add_accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4");
  file.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
  const int joint =
      file.add_node({{"translation", {0, 0, 0}}, {"rotation", {0, 0, 0, 1}}, {"scale", {1, 1, 1}}});
  file.add_node({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}, joint);
  file.add("skins", {{"joints", {joint}}, {"inverseBindMatrices", matrix}});
  file.root["nodes"][0]["skin"] = 0;
  file.root["buffers"] = json::array({{{"byteLength", file.bin.size()}}});
  return file;
}

}  // namespace focal_test
