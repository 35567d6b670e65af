// Skeletons and weights go into the caller's file and come back the same; what is wrong with a skin is said.
#include <limits>

#include "base/atomic_file.h"
#include "base/error.h"
#include "evaluation_data.h"
#include "gltf/one_call.h"
#include "gltf/small_skin.h"

using namespace focal;
using namespace focal_test;

TEST_CASE("a skin put into a file is read back the same") {
  std::vector<std::byte> written;
  through_file(tetrahedron().glb(), &written);
  const json root = parsed(written);
  CHECK(root["nodes"][0]["skin"] == 0);  // a root without a place keeps its node
  CHECK(root["skins"].size() == 1);
  const auto& group = root["nodes"][root["scenes"][0]["nodes"].front().get<size_t>()];
  CHECK(group["name"] == "focal_skeleton");
  CHECK(group["children"].size() == 1);
}

TEST_CASE("more than four influences go into a second set, which the next skin removes") {
  const std::vector<std::byte> source = tetrahedron().glb();
  const GltfMesh mesh = read_gltf_memory(source);
  const Rig plain = two_joints(static_cast<size_t>(mesh.mesh.vertex_count()));
  Rig rich = plain;
  rich.more.assign(rich.influences.size(), VertexInfluences{{{1, 0.125F}}});
  const auto attributes_of = [](const std::vector<std::byte>& file) {
    return parsed(file)["meshes"][0]["primitives"][0]["attributes"];
  };
  const auto eight = add_skin(source, mesh.primitives, {&rich, tips(), {}, {}, &mesh.mesh});
  for (const char* name : {"JOINTS_0", "WEIGHTS_0", "JOINTS_1", "WEIGHTS_1"})
    CHECK(attributes_of(eight).contains(name));
  const GltfMesh again = read_gltf_memory(eight);
  const auto read = read_gltf_rig(eight, again.primitives);
  REQUIRE(read.has_value());
  CHECK(read->influences[1][1].weight == doctest::Approx(0.375 / 1.125));  // both sets count
  const auto four = add_skin(eight, again.primitives, {&plain, tips(), {}, {}, &again.mesh});
  CHECK(attributes_of(four).contains("WEIGHTS_0"));
  CHECK_FALSE(attributes_of(four).contains("JOINTS_1"));
  CHECK_FALSE(attributes_of(four).contains("WEIGHTS_1"));
}

TEST_CASE("what a skin lacks") {
  const auto rig_of = [](const GltfBuilder& file) {
    const auto bytes = file.glb();
    return read_gltf_rig(bytes, read_gltf_memory(bytes).primitives);
  };
  CHECK_FALSE(rig_of(tetrahedron()).has_value());
  CHECK(rig_of(skinned_tetrahedron(0)).has_value());
  CHECK_THROWS_AS(rig_of(skinned_tetrahedron(1)), Error);  // a joint that is not there
  const auto idle = rig_of(skinned_tetrahedron(0, 0));     // joints without influence
  REQUIRE(idle.has_value());
  CHECK(idle->influences[0][0].weight == 0);
  for (const float wrong :
       {-0.5f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const auto bytes = skinned_tetrahedron(0, wrong).glb();  // left out, and counted
    int64_t invalid = -1;
    const auto none = read_gltf_rig(bytes, read_gltf_memory(bytes).primitives, &invalid);
    REQUIRE(none.has_value());
    CHECK(invalid == 16);
    CHECK(none->influences[0][0].weight == 0);
  }
  GltfBuilder cyclic = skinned_tetrahedron();
  cyclic.root["nodes"][1]["children"] = {1};
  CHECK_THROWS_AS(rig_of(cyclic), Error);
  GltfBuilder singular = skinned_tetrahedron();
  singular.root["skins"][0]["inverseBindMatrices"] = singular.add_accessor(std::vector<float>(16, 0), "MAT4");
  CHECK_THROWS_AS(rig_of(singular), Error);
  GltfBuilder two = skinned_tetrahedron();
  two.root["meshes"].push_back(two.root["meshes"][0]);
  const int bone = two.add_node({{"name", "other"}});
  two.root["skins"].push_back({{"joints", {bone}}});
  two.add_node({{"mesh", 1}, {"skin", 1}});
  const auto both = rig_of(two);
  REQUIRE(both.has_value());
  CHECK(both->joints.size() == 2);
  CHECK(both->influences[0][0].joint != both->influences[4][0].joint);
}

TEST_CASE("a thousand joints are numbered in 16 bits") {
  const auto source = tetrahedron().glb();
  const GltfMesh mesh = read_gltf_memory(source);
  Rig rig;
  for (int32_t j = 0; j < 1000; ++j)
    rig.joints.push_back({"j" + std::to_string(j), j - 1, Matrix4::Identity()});
  for (int32_t v = 0; v < 4; ++v) rig.influences.push_back({{{999 - v, 1}}});
  const auto written = add_skin(source, mesh.primitives, {&rig, {}});
  const auto read = read_gltf_rig(written, read_gltf_memory(written).primitives);
  REQUIRE(read.has_value());
  check_same(*read, rig);
}

TEST_CASE("joints may stand in another pose than they are bound in") {
  const auto source = tetrahedron().glb();
  const GltfMesh mesh = read_gltf_memory(source);
  const Rig rig = two_joints(4);
  std::vector<Matrix4> pose = {rig.joints[0].bind, place(0.2, {1, 0, 0}, {3, 0, 0})};
  const auto written = add_skin(source, mesh.primitives, {&rig, {}, pose, {}});
  const GltfMesh again = read_gltf_memory(written);
  const auto read = read_gltf_rig(written, again.primitives);
  REQUIRE(read.has_value());
  check_same(*read, rig);
  CHECK_FALSE(again.warnings.empty());  // shown in another pose than bound
  pose.pop_back();
  CHECK_THROWS_AS(add_skin(source, mesh.primitives, {&rig, {}, pose, {}}), Error);
}

TEST_CASE("joints and weights are four a vertex, for as many vertices as the mesh has") {
  for (const char* attribute : {"JOINTS_0", "WEIGHTS_0"}) {
    GltfBuilder file = skinned_tetrahedron();
    const auto accessor = file.root["meshes"][0]["primitives"][0]["attributes"][attribute].get<size_t>();
    file.root["accessors"][accessor]["type"] = "VEC3";
    const auto bytes = file.glb();
    CHECK_THROWS_WITH_AS(read_gltf_rig(bytes, read_gltf_memory(bytes).primitives),
                         "joints or weights of a primitive are not four per vertex", Error);
  }
  const auto bytes = skinned_tetrahedron().glb();
  auto primitives = read_gltf_memory(bytes).primitives;
  primitives[0].vertex_count = 5;  // of another file
  CHECK_THROWS_WITH_AS(read_gltf_rig(bytes, primitives),
                       "joints or weights of a primitive are not four per vertex", Error);
  GltfBuilder bare = tetrahedron();
  bare.root.erase("nodes"), bare.root.erase("scenes"), bare.root.erase("scene");
  const auto without_nodes = bare.glb();
  CHECK_FALSE(read_gltf_rig(without_nodes, read_gltf_memory(without_nodes).primitives).has_value());
}

TEST_CASE("a rig that does not suit the mesh, or is not finite, is refused") {
  const auto source = tetrahedron().glb();
  const auto primitives = read_gltf_memory(source).primitives;
  const auto error_of_rig = [&](const Rig& rig, const std::vector<Vector3>& tips = {},
                                const std::vector<Matrix4>& pose = {}) -> std::string {
    try {
      add_skin(source, primitives, {&rig, tips, pose, {}});
      return "";
    } catch (const Error& error) {
      CHECK(error.status() == Status::invalid_argument);
      return error.what();
    }
  };
  const Rig good = two_joints(4);
  const std::vector<Matrix4> pose(2, Matrix4::Identity());
  CHECK(error_of_rig(good, tips(), pose) == "");
  const std::string unsuitable = "the rig does not suit the mesh";
  CHECK(error_of_rig(two_joints(3)) == unsuitable);
  CHECK(error_of_rig(two_joints(5)) == unsuitable);
  Rig none = two_joints(4);
  none.joints.clear();
  CHECK(error_of_rig(none) == unsuitable);
  CHECK(error_of_rig(good, {{0, 0, 1}}) == unsuitable);
  CHECK(error_of_rig(good, tips(), {pose[0]}) == unsuitable);
  CHECK(error_of_rig(good, {{0, 0, 1}}, pose) == unsuitable);
  std::vector<Matrix4> far = pose;
  far[1](0, 3) = 1e300;  // finite in double precision alone
  CHECK(error_of_rig(good, {}, far) == "a joint's pose is not finite");
  Rig lost = good;
  lost.joints[1].bind(2, 3) = std::numeric_limits<double>::quiet_NaN();
  CHECK(error_of_rig(lost) == "joint 'tip \"x\"' is not finite");
}

TEST_CASE("as many joints as 16 bits number, and no more") {
  const auto source = tetrahedron().glb();
  const auto primitives = read_gltf_memory(source).primitives;
  Rig rig;
  for (int32_t j = 0; j < 65536; ++j) rig.joints.push_back({"j", j < 2 ? j - 1 : 1, Matrix4::Identity()});
  for (int32_t v = 0; v < 4; ++v) rig.influences.push_back({{{65535 - v, 1}}});
  const auto written = add_skin(source, primitives, {&rig, {}});
  const auto read = read_gltf_rig(written, read_gltf_memory(written).primitives);
  REQUIRE(read.has_value());
  CHECK(read->influences[0][0].joint == 65535);
  rig.joints.push_back(rig.joints.back());
  CHECK_THROWS_AS(add_skin(source, primitives, {&rig, {}}), Error);
}

TEST_CASE("the rigs of real characters survive being written once more") {
  const auto folder = evaluation_set("rigs");
  if (!folder) return;
  for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
    if (entry.path().extension() != ".glb") continue;
    CAPTURE(entry.path());
    const auto source = read_file(entry.path());
    const GltfMesh mesh = read_gltf_memory(source);
    auto rig = read_gltf_rig(source, mesh.primitives);
    REQUIRE(rig.has_value());
    for (Joint& joint : rig->joints) {  // focal writes rigid joints
      Matrix3 linear = joint.bind.topLeftCorner<3, 3>();
      joint.bind.topLeftCorner<3, 3>() =
          Eigen::Quaterniond(linear / std::cbrt(std::abs(linear.determinant())))
              .normalized()
              .toRotationMatrix();
    }
    const bool moves_all = std::all_of(rig->influences.begin(), rig->influences.end(),
                                       [](const VertexInfluences& one) { return one[0].weight > 0; });
    const auto written = add_skin(source, mesh.primitives, {&*rig, {}});
    const GltfMesh again = read_gltf_memory(written);
    CHECK(again.mesh.vertex_count() == mesh.mesh.vertex_count());
    const auto read = read_gltf_rig(written, again.primitives);
    REQUIRE(read.has_value());
    CHECK(read->joints.size() == rig->joints.size());
    if (moves_all) CHECK(read->influences.size() == rig->influences.size());
  }
}
