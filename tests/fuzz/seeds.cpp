#include "seeds.h"

#include <array>

#include "analysis/analysis_file.h"
#include "analysis/surface_analysis.h"
#include "gltf/gltf_builder.h"
#include "landmark_files.h"
#include "model/model_file.h"
#include "model/small_model.h"

using namespace focal;
using focal_test::GltfBuilder;
using nlohmann::json;

namespace fuzz {
namespace {

constexpr int side = 3;

TriangleMesh box() {
  std::map<std::array<int, 3>, int32_t> number;
  std::vector<std::array<int, 3>> places;
  std::vector<std::array<int32_t, 3>> triangles;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [entry, is_new] = number.try_emplace(at, static_cast<int32_t>(places.size()));
    if (is_new) places.push_back(at);
    return entry->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int level : {0, side})
      for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
          std::array<int32_t, 4> corner;
          for (int c = 0; c < 4; ++c) {
            std::array<int, 3> at;
            at[axis] = level, at[(axis + 1) % 3] = i + (c == 1 || c == 2), at[(axis + 2) % 3] = j + (c >= 2);
            corner[c] = vertex(at);
          }
          if (level == 0) std::swap(corner[1], corner[3]);  // outwards
          triangles.push_back({corner[0], corner[1], corner[2]});
          triangles.push_back({corner[0], corner[2], corner[3]});
        }
  TriangleMesh mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(places.size()), 3);
  for (size_t v = 0; v < places.size(); ++v)
    mesh.positions.row(static_cast<Eigen::Index>(v)) << places[v][0], places[v][1], 2 * places[v][2];
  mesh.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (size_t t = 0; t < triangles.size(); ++t)
    mesh.triangles.row(static_cast<Eigen::Index>(t)) << triangles[t][0], triangles[t][1], triangles[t][2];
  return mesh;
}

// Everything that the reader looks at: a sparse accessor, a skin, an animation, a strip, a second mesh below a mirrored node.
Bytes rich_glb() {
  GltfBuilder file = focal_test::tetrahedron();
  const int where = file.add_view(std::vector<uint8_t>{1, 3}),
            what = file.add_view(std::vector<float>{5, 6, 7, 8, 9, 10});
  file.root["accessors"][0]["sparse"] = {{"count", 2},
                                         {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", what}}}};
  const int matrix =
      file.add_accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4");
  const int strip = file.add_accessor(std::vector<uint8_t>{0, 1, 2, 3}, "SCALAR");
  const int joint = file.add_node({{"name", "joint"}, {"rotation", {0, 0, 0, 1}}});
  const int skinned = file.add_mesh(0, strip, 5);
  json& attributes = file.root["meshes"][skinned]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = file.add("accessors", {{"bufferView", file.add_view(std::vector<uint8_t>(16))},
                                                  {"componentType", 5121},
                                                  {"type", "VEC4"},
                                                  {"count", 4}});
  attributes["WEIGHTS_0"] = file.add(
      "accessors",
      {{"bufferView", file.add_view(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})},
       {"componentType", 5126},
       {"type", "VEC4"},
       {"count", 4}});
  file.add_node({{"mesh", skinned}, {"skin", 0}});
  file.add_node({{"mesh", 0}, {"scale", {-1, 1, 1}}}, joint);
  file.add("skins", {{"joints", {joint}}, {"inverseBindMatrices", matrix}});
  const int times = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  const int turns =
      file.add("accessors", {{"bufferView", file.add_view(std::vector<float>{0, 0, 0, 1, 0, 1, 0, 0})},
                             {"componentType", 5126},
                             {"type", "VEC4"},
                             {"count", 2}});
  file.add("animations",
           {{"name", "turn"},
            {"samplers", {{{"input", times}, {"output", turns}, {"interpolation", "LINEAR"}}}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", joint}, {"path", "rotation"}}}}}}});
  return file.glb();
}

Bytes small_analysis() {
  AnalysisParams params;
  params.eigenpair_count = 8, params.max_samples = 4, params.sampling_rate = 1;
  SurfaceAnalysis analysis = analyse_surface(small_mesh(), params, {});
  for (Eigen::Index i = 0; i < analysis.descriptors.size(); ++i)
    analysis.descriptors.data()[i] = static_cast<float>(i * 7 % 19) / 16;
  for (Eigen::Index i = 0; i < analysis.eigenfunctions.size(); ++i)
    analysis.eigenfunctions.data()[i] = static_cast<float>(i * 5 % 17 - 8) / 8;
  analysis.distances.step = 0.25;
  for (size_t i = 0; i < analysis.distances.steps.size(); ++i)
    analysis.distances.steps[i] = static_cast<uint16_t>(i % 50);
  return serialise(analysis);
}

void add_landmark_seeds(std::map<std::string, Bytes>& all) {
  focal_cli::LandmarkFile file{"cat.glb", {}};
  focal_cli::Landmark nose{"nose",  focal_cli::Position{0.5, -1, 2},
                           12,      focal_cli::SurfacePlace{3, {0.25, 0.25, 0.5}},
                           "found", 0.75};
  file.landmarks = {nose, {"tail", {}, {}, {}, "absent", 0.125}};
  for (int format = 0; format < 5; ++format) {
    const std::string text =
        focal_cli::format_landmarks(static_cast<focal_cli::LandmarkFormat>(format), file);
    all["landmarks/format_" + std::to_string(format)] =
        focal_test::bytes_of(static_cast<char>(format) + text);
  }
  all["landmarks/template"] = focal_test::bytes_of(
      "\5{\"format\":\"focal-skeleton-template\",\"version\":1,\"symmetric\":true,\"joints\":["
      "{\"name\":\"hips\",\"between\":[\"a\",\"b\"],\"share\":0.4,\"rest\":[0,1,0]},"
      "{\"name\":\"spine\",\"parent\":\"hips\",\"centre\":[\"a\",\"c\"],\"tip\":\"b\"},{\"name\":\"arm.L\","
      "\"parent\":\"spine\",\"surface\":[\"a\"]}]}");
}

}  // namespace

std::shared_ptr<const PreparedMesh> small_mesh() {
  return std::make_shared<const PreparedMesh>(prepare(box()));
}

std::map<std::string, Bytes> seeds() {
  std::map<std::string, Bytes> all;
  all["gltf/tetrahedron.glb"] = focal_test::tetrahedron().glb();
  all["gltf/rich.glb"] = rich_glb();
  all["gltf/text.gltf"] = focal_test::tetrahedron().gltf(
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"
      "AAACAAEAAAABAAMAAAADAAIAAQACAAMA");
  all["model/default.focal"] = serialise(focal_test::small_model(Preset::default_preset));
  all["model/paper.focal"] = serialise(focal_test::small_model(Preset::paper));
  all["model/analysis"] = small_analysis();
  add_landmark_seeds(all);
  // Each byte is a call or an argument: all calls in their order with good handles, then mixtures.
  for (int step : {1, 3, 7, 11, 29}) {
    Bytes calls;
    for (int i = 0; i < 240; ++i) calls.push_back(std::byte(i * step % 251));
    all["calls/step_" + std::to_string(step)] = calls;
  }
  return all;
}

}  // namespace fuzz
