// A small rig, and what puts it into a file and reads it again.
#pragma once
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <span>
#include <vector>

#include "gltf/document.h"
#include "gltf/gltf_builder.h"
#include "gltf/one_call.h"
#include "gltf/preflight.h"

namespace focal_test {

using focal::GltfMesh;
using focal::Matrix4;
using focal::Rig;
using focal::Vector3;
using focal::VertexInfluences;

inline Matrix4 place(double angle, const Vector3& axis, const Vector3& at) {
  Matrix4 result = Matrix4::Identity();
  result.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  result.topRightCorner<3, 1>() = at;
  return result;
}

inline Rig two_joints(size_t vertices) {
  Rig rig;
  rig.joints = {{"root", -1, place(0.3, {1, 2, 3}, {0, 0, 0.5})},
                {"tip \"x\"", 0, place(1, {0, 1, 0}, {1, 0, 0})}};
  for (size_t v = 0; v < vertices; ++v)
    rig.influences.push_back(v == 0 ? VertexInfluences{{{1, 1}}}
                                    : VertexInfluences{{{0, 0.75F}, {1, 0.25F}}});
  return rig;
}

inline std::vector<Vector3> tips() { return {{0, 0, 1}, {2, 0, 0}}; }

inline void check_same(const Rig& a, const Rig& b) {
  REQUIRE(a.joints.size() == b.joints.size());
  for (size_t j = 0; j < a.joints.size(); ++j) {
    CHECK(a.joints[j].name == b.joints[j].name);
    CHECK(a.joints[j].parent == b.joints[j].parent);
    CHECK((a.joints[j].bind - b.joints[j].bind).norm() < 1e-5);
  }
  REQUIRE(a.influences.size() == b.influences.size());
  for (size_t v = 0; v < a.influences.size(); ++v)
    for (size_t i = 0; i < a.influences[v].size(); ++i) {
      if (a.influences[v][i].weight > 0) CHECK(a.influences[v][i].joint == b.influences[v][i].joint);
      CHECK(a.influences[v][i].weight == doctest::Approx(b.influences[v][i].weight).epsilon(1e-5));
    }
}

// With a rig of two joints put in and read again.
inline Rig through_file(const std::vector<std::byte>& source, std::vector<std::byte>* written = nullptr) {
  const GltfMesh mesh = focal_test::read_gltf_memory(source);
  const Rig rig = two_joints(static_cast<size_t>(mesh.mesh.vertex_count()));
  const auto result = focal_test::add_skin(source, mesh.primitives, {&rig, tips(), {}, {}, &mesh.mesh});
  const GltfMesh again = focal_test::read_gltf_memory(result);
  CHECK((again.mesh.positions - mesh.mesh.positions).norm() < 1e-5);
  const auto read = focal_test::read_gltf_rig(result, again.primitives);
  REQUIRE(read.has_value());
  check_same(*read, rig);
  if (written) *written = result;
  return *read;
}

inline json parsed(std::span<const std::byte> bytes) {
  const auto text = focal::open_container(bytes, {}).json;
  return json::parse(reinterpret_cast<const char*>(text.data()),
                     reinterpret_cast<const char*>(text.data()) + text.size());
}

// A tetrahedron moved by one joint, with what the arguments change.
inline GltfBuilder skinned_tetrahedron(uint8_t joint = 0, float weight = 1) {
  GltfBuilder file = tetrahedron();
  const int joints = file.add_accessor(std::vector<uint8_t>(16, joint), "SCALAR");
  const int weights = file.add_accessor(std::vector<float>(16, weight), "SCALAR");
  for (const int accessor : {joints, weights}) {
    file.root["accessors"][static_cast<size_t>(accessor)]["type"] = "VEC4";
    file.root["accessors"][static_cast<size_t>(accessor)]["count"] = 4;
  }
  auto& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = joints, attributes["WEIGHTS_0"] = weights;
  const int bone = file.add_node({{"name", "bone"}, {"translation", {0, 1, 0}}});
  file.root["skins"] = json::array({{{"joints", {bone}}}});
  file.root["nodes"][0]["skin"] = 0;
  return file;
}

// Numbers of four an entry.
template <class T>
int add_fours(GltfBuilder& file, const std::vector<T>& values) {
  const int accessor = file.add_accessor(values, "SCALAR");
  json& element = file.root["accessors"][static_cast<size_t>(accessor)];
  element["type"] = "VEC4", element["count"] = values.size() / 4;
  return accessor;
}

// Two tetrahedra, each modelled about its own joint, in one primitive; the second joint stands 3 up and turned about z.
inline GltfBuilder segments() {
  GltfBuilder file;
  std::vector<float> positions = tetrahedron_corners;
  positions.insert(positions.end(), tetrahedron_corners.begin(), tetrahedron_corners.end());
  std::vector<uint16_t> faces = tetrahedron_faces;
  for (const uint16_t corner : tetrahedron_faces) faces.push_back(static_cast<uint16_t>(corner + 4));
  const int places = file.add_accessor(positions, "VEC3");
  file.add_mesh(places, file.add_accessor(faces, "SCALAR"));
  std::vector<uint8_t> joints(32, 0);
  std::vector<float> weights(32, 0), normals, offsets;
  for (size_t v = 0; v < 8; ++v) {
    joints[4 * v] = v >= 4, weights[4 * v] = 1;
    for (const float x : {1.0F, 0.0F, 0.0F}) normals.push_back(x);
    for (const float x : {0.0F, 0.5F, 0.0F}) offsets.push_back(x);
  }
  json& primitive = file.root["meshes"][0]["primitives"][0];
  primitive["attributes"]["JOINTS_0"] = add_fours(file, joints);
  primitive["attributes"]["WEIGHTS_0"] = add_fours(file, weights);
  primitive["attributes"]["NORMAL"] = file.add_accessor(normals, "VEC3");
  primitive["targets"] = {{{"POSITION", file.add_accessor(offsets, "VEC3")}}};
  file.add_node({{"mesh", 0}, {"skin", 0}});
  const int low = file.add_node({{"name", "low"}});
  const float half = std::numbers::sqrt2_v<float> / 2;
  const int high =
      file.add_node({{"name", "high"}, {"translation", {0, 3, 0}}, {"rotation", {0, 0, half, half}}}, low);
  file.root["skins"] = json::array({{{"joints", {low, high}}}});
  return file;
}

}  // namespace focal_test
