// One body in two meshes, each with a skin of its own over the same joints: modelled in metres and in centimetres, and rounded apart by
// that. It is read as one closed surface.
#include <map>

#include "gltf/small_skin.h"
#include "mesh/prepare.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

// One half of a sphere as a mesh of the file, in a unit of its own.
void add_half(GltfBuilder& file, const TriangleMesh& whole, bool is_upper, double unit, int skin) {
  std::map<int32_t, uint16_t> copies;
  std::vector<float> places, weights;
  std::vector<uint16_t> corners;
  std::vector<uint8_t> joints;
  for (int32_t t = 0; t < whole.triangle_count(); ++t) {
    double height = 0;
    for (int i = 0; i < 3; ++i) height += whole.positions(whole.triangles(t, i), 1);
    if ((height > 0) != is_upper) continue;
    for (int i = 0; i < 3; ++i) {
      const int32_t v = whole.triangles(t, i);
      const auto [copy, is_new] = copies.try_emplace(v, static_cast<uint16_t>(copies.size()));
      corners.push_back(copy->second);
      if (!is_new) continue;
      for (int axis = 0; axis < 3; ++axis)
        places.push_back(static_cast<float>(whole.positions(v, axis) / unit));
      for (int k = 0; k < 4; ++k)
        joints.push_back(k == 1), weights.push_back(k == 0 ? 0.75F : k == 1 ? 0.25F : 0);
    }
  }
  const int positions = file.add_accessor(places, "VEC3");
  const int mesh = file.add_mesh(positions, file.add_accessor(corners, "SCALAR"));
  json& attributes = file.root["meshes"][static_cast<size_t>(mesh)]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = add_fours(file, joints), attributes["WEIGHTS_0"] = add_fours(file, weights);
  file.add_node({{"mesh", mesh}, {"skin", skin}});
}

int add_bind_matrices(GltfBuilder& file, const std::vector<Matrix4>& joints, double unit) {
  std::vector<float> numbers;
  for (const Matrix4& joint : joints) {
    Matrix4 inverse = joint.inverse();
    inverse.leftCols<3>() *= unit;
    for (int i = 0; i < 16; ++i) numbers.push_back(static_cast<float>(inverse.data()[i]));
  }
  return file.add_accessor(numbers, "MAT4");
}

GltfBuilder halves(const TriangleMesh& whole) {
  GltfBuilder file;
  file.root["scenes"] = json::array({{{"nodes", json::array()}}});
  const std::vector<Matrix4> joints = {place(0.7, {1, 2, 3}, {0.1, 0.2, 0.3}),
                                       place(1.1, {3, -1, 1}, {0.3, -0.4, 0.2})};
  const auto put = [](json& node, const Matrix4& at) {
    for (int i = 0; i < 16; ++i) node["matrix"].push_back(at.data()[i]);
  };
  json low = {{"name", "low"}}, high = {{"name", "high"}};
  put(low, joints[0]), put(high, joints[0].inverse() * joints[1]);
  const int first = file.add_node(low);
  const int second = file.add_node(high, first);
  for (const double unit : {1.0, 0.01})
    file.add("skins",
             {{"joints", {first, second}}, {"inverseBindMatrices", add_bind_matrices(file, joints, unit)}});
  add_half(file, whole, true, 1, 0);
  add_half(file, whole, false, 0.01, 1);
  return file;
}

}  // namespace

TEST_CASE("two skins over the same joints, in metres and centimetres, show one closed surface") {
  const TriangleMesh whole = sphere(4);
  const auto source = halves(whole).glb();
  const GltfMesh read = read_gltf_memory(source);
  REQUIRE(read.mesh.vertex_count() > whole.vertex_count());
  for (int32_t v = 0; v < read.mesh.vertex_count(); ++v)
    CHECK(std::abs(read.mesh.positions.row(v).norm() - 1) < 1e-5);
  const PreparedMesh prepared = prepare(read.mesh);
  CHECK(prepared.components == 1);
  CHECK(prepared.topology->boundary_loops == 0);
  CHECK(prepared.surface.vertex_count() == whole.vertex_count());
  CHECK(surface_area(read.mesh) == doctest::Approx(surface_area(whole)).epsilon(1e-5));
  const auto rig = read_gltf_rig(source, read.primitives);
  REQUIRE(rig.has_value());
  CHECK(rig->joints.size() == 2);  // not four
}
