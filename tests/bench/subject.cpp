#include "subject.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "creatures/character.h"
#include "gltf/document.h"
#include "landmarks/train.h"
#include "large_mesh.h"
#include "mesh/nearest_vertex.h"
#include "placing.h"

namespace focal_bench {
namespace {

using namespace focal;
namespace fs = std::filesystem;

nlohmann::json json_of(const fs::path& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

std::optional<fs::path> folder_of(const std::string& name) {
  const char* data = std::getenv("FOCAL_EVALUATION_DATA");
  if (!data || !fs::exists(fs::path(data) / name / "set.json")) return std::nullopt;
  return fs::path(data) / name;
}

MarkedShape marked_mesh(const fs::path& folder, const std::string& name,
                        const std::vector<std::string>& names) {
  MarkedShape shape{
      std::make_shared<PreparedMesh>(prepare(GltfDocument::open(folder / (name + ".glb")).mesh().mesh)), {}};
  shape.marks.resize(names.size());
  const auto marks = json_of(folder / (name + ".landmarks.json"));
  for (const auto& mark : marks["landmarks"]) {
    const auto at = std::find(names.begin(), names.end(), mark["name"].get<std::string>());
    const int32_t vertex = shape.mesh->surface_vertex.at(mark["vertex"].get<size_t>());
    if (at != names.end() && vertex >= 0)
      shape.marks[at - names.begin()] = at_vertex(shape.mesh->surface, vertex);
  }
  return shape;
}

std::string title(const std::string& name, const Subject& subject) {
  return name + ", " + std::to_string(subject.test.vertex_count()) + " vertices, " +
         std::to_string(subject.training.landmark_names.size()) + " landmarks";
}

TriangleMesh posed_mesh(const creatures::Character& character) {
  TriangleMesh mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(character.posed.size()), 3);
  for (size_t v = 0; v < character.posed.size(); ++v) mesh.positions.row(v) = character.posed[v];
  mesh.triangles.resize(static_cast<Eigen::Index>(character.rest.triangles.size()), 3);
  for (size_t t = 0; t < character.rest.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) mesh.triangles(t, i) = character.rest.triangles[t][i];
  return mesh;
}

// The marks move to the nearest vertices of the resized mesh.
MarkedShape resized_shape(const creatures::Character& character, int32_t vertex_count, uint64_t seed) {
  const TriangleMesh original = posed_mesh(character);
  MarkedShape shape{std::make_shared<PreparedMesh>(prepare(resized(original, vertex_count, seed))), {}};
  const auto& mesh = *shape.mesh;
  std::vector<int32_t> all(mesh.source.vertex_count());
  for (int32_t v = 0; v < mesh.source.vertex_count(); ++v) all[v] = v;
  const NearestVertex search(mesh.source.positions, all);
  for (const auto& mark : character.landmarks) {
    const auto place = position_of(original, {mark.triangle, mark.barycentric});
    shape.marks.push_back(at_vertex(mesh.surface, mesh.surface_vertex[search.nearest(place).first]));
  }
  return shape;
}

}  // namespace

std::optional<MarkedSet> marked_set(const std::string& name) {
  const auto folder = folder_of(name);
  if (!folder) return std::nullopt;
  const auto about = json_of(*folder / "set.json");
  MarkedSet set;
  set.name = name;
  const auto& names = set.training.landmark_names = about["landmark_names"].get<std::vector<std::string>>();
  for (const auto& mesh : about["train"]) set.training.shapes.push_back(marked_mesh(*folder, mesh, names));
  set.test_names = about["test"].get<std::vector<std::string>>();
  for (const auto& mesh : set.test_names) set.test.push_back(marked_mesh(*folder, mesh, names));
  return set;
}

std::optional<Subject> real_set(const std::string& name) {
  auto set = marked_set(name);
  if (!set) return std::nullopt;
  Subject subject{name, std::move(set->training), set->test[0].mesh->source};
  subject.name = title(name, subject);
  return subject;
}

Subject sample_people(int shapes, int32_t vertex_count) {
  const auto& humanoid = creatures::families()[0];
  Subject subject;
  for (int i = 0; i <= shapes; ++i) {
    const uint64_t seed = 100 + static_cast<uint64_t>(i);
    const auto character = creatures::make_character(humanoid, "person", seed);
    auto shape = resized_shape(character, vertex_count, seed);
    if (i == shapes) {
      for (const auto& mark : character.landmarks) subject.training.landmark_names.push_back(mark.name);
      subject.test = shape.mesh->source;
    } else {
      subject.training.shapes.push_back(std::move(shape));
    }
  }
  subject.name = title("sample people", subject);
  return subject;
}

Subject set_or_people(const std::string& name) {
  if (auto set = real_set(name)) return *std::move(set);
  return sample_people(10, 12500);
}

std::shared_ptr<const LandmarkModel> trained(const Subject& subject, const TrainParams& params, int threads) {
  return std::make_shared<LandmarkModel>(train(subject.training, params, threads_of(threads)));
}

}  // namespace focal_bench
