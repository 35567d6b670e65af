// The evaluation sets (one-primitive .glb files with marked landmarks) as test input, found through the
// environment variable FOCAL_EVALUATION_DATA. Their layout is fixed, so a small trusting reader does.
#pragma once
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace focal_test {

// The folder of one set, or nothing, said once on the output, when there is no such data here.
inline std::optional<std::filesystem::path> evaluation_set(const std::string& name) {
  const char* root = std::getenv("FOCAL_EVALUATION_DATA");
  if (root && std::filesystem::exists(std::filesystem::path(root) / name / "set.json"))
    return std::filesystem::path(root) / name;
  std::cout << "skipped: no " << name << " in FOCAL_EVALUATION_DATA\n";
  return std::nullopt;
}

inline nlohmann::json read_json(const std::filesystem::path& path) {
  return nlohmann::json::parse(std::ifstream(path));
}

inline focal::TriangleMesh read_evaluation_mesh(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::vector<char> file{std::istreambuf_iterator<char>(stream), {}};
  const auto u32 = [&](size_t at) {
    uint32_t value;
    std::memcpy(&value, file.data() + at, 4);
    return value;
  };
  const uint32_t json_size = u32(12);
  const auto gltf = nlohmann::json::parse(file.begin() + 20, file.begin() + 20 + json_size);
  const auto& primitive = gltf["meshes"][0]["primitives"][0];
  const auto data_of = [&](const nlohmann::json& accessor_index, size_t& count) {
    const auto& accessor = gltf["accessors"][accessor_index.get<size_t>()];
    const auto& view = gltf["bufferViews"][accessor["bufferView"].get<size_t>()];
    count = accessor["count"].get<size_t>();
    return 20 + json_size + 8 + view.value("byteOffset", size_t{0}) + accessor.value("byteOffset", size_t{0});
  };
  size_t vertex_count = 0, index_count = 0;
  const size_t positions = data_of(primitive["attributes"]["POSITION"], vertex_count);
  const size_t indices = data_of(primitive["indices"], index_count);
  focal::TriangleMesh mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(vertex_count), 3);
  for (Eigen::Index i = 0; i < mesh.positions.size(); ++i) {
    float value;
    std::memcpy(&value, file.data() + positions + 4 * static_cast<size_t>(i), 4);
    mesh.positions.data()[i] = value;
  }
  mesh.triangles.resize(static_cast<Eigen::Index>(index_count / 3), 3);
  for (Eigen::Index i = 0; i < mesh.triangles.size(); ++i)
    mesh.triangles.data()[i] = static_cast<int32_t>(u32(indices + 4 * static_cast<size_t>(i)));
  return mesh;
}

// Vertex number of each landmark.
inline std::map<std::string, int32_t> read_evaluation_landmarks(const std::filesystem::path& path) {
  std::map<std::string, int32_t> vertices;
  const nlohmann::json file = read_json(path);
  for (const auto& landmark : file["landmarks"])
    vertices[landmark["name"].get<std::string>()] = landmark["vertex"].get<int32_t>();
  return vertices;
}

}  // namespace focal_test
