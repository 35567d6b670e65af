// A small rig, and what puts it into a file and reads it again.
#pragma once
#include <doctest/doctest.h>

#include <Eigen/Geometry>
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

}  // namespace focal_test
