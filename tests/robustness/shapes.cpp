#include "shapes.h"

#include <algorithm>
#include <fstream>

#include "creatures/character.h"
#include "evaluation_data.h"

namespace focal_robustness {
namespace {

using namespace focal;

Shape read_shape(const std::filesystem::path& set, const std::string& name,
                 const std::vector<std::string>& landmark_names) {
  Shape shape{name, focal_test::read_evaluation_mesh(set / (name + ".glb")), {}, {}};
  const auto vertices = focal_test::read_evaluation_landmarks(set / (name + ".landmarks.json"));
  for (const auto& landmark : landmark_names) {
    const auto at = vertices.find(landmark);
    shape.marks.emplace_back();
    if (at != vertices.end()) shape.marks.back() = at_vertex(shape.mesh, at->second);
  }
  std::ifstream rows(set / (name + ".corr.txt"));
  for (int32_t vertex; rows >> vertex;) shape.dense.push_back(vertex);
  return shape;
}

Shape sample_humanoid(const creatures::Family& family, int number) {
  const auto character =
      creatures::make_character(family, "humanoid_" + std::to_string(number), 100 + number);
  Shape shape{character.name, {}, {}, {}};
  shape.mesh.positions.resize(static_cast<Eigen::Index>(character.posed.size()), 3);
  for (size_t v = 0; v < character.posed.size(); ++v) shape.mesh.positions.row(v) = character.posed[v];
  shape.mesh.triangles.resize(static_cast<Eigen::Index>(character.rest.triangles.size()), 3);
  for (size_t t = 0; t < character.rest.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) shape.mesh.triangles(t, i) = character.rest.triangles[t][i];
  for (const auto& mark : character.landmarks)
    shape.marks.push_back(SurfacePoint{mark.triangle, mark.barycentric});
  return shape;
}

Shapes sample_shapes() {
  const auto& families = creatures::families();
  const auto family = std::find_if(families.begin(), families.end(),
                                   [](const creatures::Family& f) { return f.name == "humanoid"; });
  Shapes shapes{"sample humanoids", {}, {}, {}};
  for (const auto& mark : creatures::make_character(*family, "names", 100).landmarks)
    shapes.landmark_names.push_back(mark.name);
  for (int i = 0; i < 18; ++i)
    (i < 10 ? shapes.training : shapes.judged).push_back(sample_humanoid(*family, i));
  return shapes;
}

void keep_some(std::vector<Shape>& shapes, int32_t limit) {
  const auto count = static_cast<int32_t>(shapes.size());
  if (limit <= 0 || limit >= count) return;
  std::vector<Shape> kept;
  for (int32_t i = 0; i < limit; ++i)
    kept.push_back(std::move(shapes[static_cast<size_t>(i * count / limit)]));
  shapes = std::move(kept);
}

}  // namespace

int32_t Shapes::landmark(const std::string& name) const {
  const auto at = std::find(landmark_names.begin(), landmark_names.end(), name);
  return at == landmark_names.end() ? -1 : static_cast<int32_t>(at - landmark_names.begin());
}

Shapes load_shapes(Split split, int32_t limit) {
  Shapes shapes;
  if (const auto set = focal_test::evaluation_set("faust5k")) {
    const auto about = focal_test::read_json(*set / "set.json");
    shapes.set = "faust5k";
    shapes.landmark_names = about["landmark_names"].get<std::vector<std::string>>();
    for (const auto& name : about["train"])
      shapes.training.push_back(read_shape(*set, name, shapes.landmark_names));
    for (const auto& name : about[split == Split::test ? "test" : "extra"])
      shapes.judged.push_back(read_shape(*set, name, shapes.landmark_names));
  } else {
    shapes = sample_shapes();
  }
  keep_some(shapes.judged, limit);
  return shapes;
}

TriangleMesh in_single_precision(TriangleMesh mesh) {
  mesh.positions = mesh.positions.cast<float>().cast<double>();
  return mesh;
}

MarkedShape prepared(const Shape& shape) {
  MarkedShape result{std::make_shared<PreparedMesh>(prepare(in_single_precision(shape.mesh))), {}};
  for (const auto& mark : shape.marks) {
    result.marks.emplace_back();
    if (mark) result.marks.back() = to_surface(*result.mesh, *mark);
  }
  return result;
}

}  // namespace focal_robustness
