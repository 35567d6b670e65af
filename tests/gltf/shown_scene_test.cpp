// What is read is what a viewer shows: morph weights, skins without bind matrices, meshes on joints, names of joints.
#include <Eigen/Geometry>

#include "base/error.h"
#include "gltf/small_skin.h"

using namespace focal;
using namespace focal_test;

namespace {

bool mentions(const std::vector<std::string>& warnings, const std::string& text) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const std::string& one) { return one.find(text) != std::string::npos; });
}

}  // namespace

TEST_CASE("morph targets count with the weights that the file shows, the node's before the mesh's") {
  GltfBuilder file = tetrahedron();
  const int up = file.add_accessor(std::vector<float>{0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0}, "VEC3");
  const int aside = file.add_accessor(std::vector<float>(12, 1), "VEC3");
  file.root["meshes"][0]["primitives"][0]["targets"] = {
      {{"POSITION", up}}, {{"POSITION", aside}}, {{"NORMAL", up}}};
  const auto third = [&] { return Vector3(read_gltf_memory(file.glb()).mesh.positions.row(2).transpose()); };
  CHECK(third() == Vector3(0, 1, 0));
  file.root["meshes"][0]["weights"] = {0.5, 0.25, 1};
  CHECK((third() - Vector3(0.25, 2.25, 0.25)).norm() < 1e-6);
  file.root["nodes"][0]["weights"] = {1};
  CHECK((third() - Vector3(0, 3, 0)).norm() < 1e-6);
  file.root["nodes"][0]["weights"] = {"x"};
  CHECK_THROWS_AS(third(), Error);
}

TEST_CASE("a skin without bind matrices shows what its joints place") {
  const GltfBuilder file = segments();
  const auto source = file.glb();
  const GltfMesh mesh = read_gltf_memory(source);
  CHECK(mentions(mesh.warnings, "its bind matrices make no shape"));
  CHECK((mesh.mesh.positions.row(1) - Eigen::RowVector3d(1, 0, 0)).norm() < 1e-6);
  CHECK((mesh.mesh.positions.row(5) - Eigen::RowVector3d(0, 4, 0)).norm() < 1e-6);  // (1, 0, 0), turned
  const auto rig = read_gltf_rig(source, mesh.primitives);
  REQUIRE(rig.has_value());
  CHECK((rig->joints[1].bind.topRightCorner<3, 1>() - Vector3(0, 3, 0)).norm() < 1e-6);
  CHECK(rig->influences[5][0].joint == 1);
  // The same with matrices that say the same.
  GltfBuilder same = segments();
  std::vector<float> units;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 16; ++i) units.push_back(i % 5 == 0);
  same.root["skins"][0]["inverseBindMatrices"] = same.add_accessor(units, "MAT4");
  CHECK(read_gltf_memory(same.glb()).mesh.positions == mesh.mesh.positions);
}

TEST_CASE("such a mesh keeps its shape, its normals and its morph targets when it gets another skin") {
  const auto source = segments().glb();
  std::vector<std::byte> written;
  {
    const GltfMesh mesh = read_gltf_memory(source);
    const Rig rig = two_joints(8);
    written = add_skin(source, mesh.primitives, {&rig, tips(), {}, {}, &mesh.mesh});
    const GltfMesh again = read_gltf_memory(written);
    CHECK((again.mesh.positions - mesh.mesh.positions).norm() < 1e-5);
    CHECK_FALSE(mentions(again.warnings, "bind matrices"));
  }
  json root = parsed(written);
  root["nodes"][0]["weights"] = {1};
  const auto shown = glb_bytes(root.dump(), bin_chunk(open_container(written, {}).bin));
  const GltfMesh smiling = read_gltf_memory(shown);  // the target moves the turned part along -x
  CHECK((smiling.mesh.positions.row(5) - Eigen::RowVector3d(-0.5, 4, 0)).norm() < 1e-5);
  root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"];
  root["meshes"][0].erase("weights"), root["nodes"][0].erase("weights");
  const auto normals = glb_bytes(root.dump(), bin_chunk(open_container(written, {}).bin));
  const MatrixX3 read = read_gltf_memory(normals, {.limits = {}, .lenient = true}).mesh.positions;
  CHECK((read.row(0) - Eigen::RowVector3d(1, 0, 0)).norm() < 1e-5);
  CHECK((read.row(5) - Eigen::RowVector3d(0, 1, 0)).norm() < 1e-5);
}

TEST_CASE("a mesh on a joint is moved by it alone, and stands where the bind pose has it") {
  GltfBuilder file = skinned_tetrahedron();
  const int bone = 1;
  file.root["skins"][0]["inverseBindMatrices"] =
      file.add_accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1}, "MAT4");
  file.add_mesh(0, 1);
  const int hand = file.add_node({{"name", "hand"}, {"translation", {2, 0, 0}}}, bone);
  file.add_node({{"name", "hat"}, {"mesh", 1}}, hand);
  const auto check = [&](const Vector3& corner) {
    const auto bytes = file.glb();
    const GltfMesh mesh = read_gltf_memory(bytes);
    REQUIRE(mesh.mesh.vertex_count() == 8);
    CHECK((mesh.mesh.positions.row(4).transpose() - corner).norm() < 1e-6);
    const auto rig = read_gltf_rig(bytes, mesh.primitives);
    REQUIRE(rig.has_value());
    CHECK(rig->influences[4][0].weight == 1);
    CHECK(rig->joints[rig->influences[4][0].joint].name == "bone");
    std::vector<std::byte> written;
    const Rig other = two_joints(8);
    written = add_skin(bytes, mesh.primitives, {&other, tips(), {}, {}, &mesh.mesh});
    CHECK((read_gltf_memory(written).mesh.positions - mesh.mesh.positions).norm() < 1e-5);
  };
  check({2, 1, 0});
  // A second joint keeps the body; this one shows another pose than it is bound in.
  const int other = file.add_node({{"name", "top"}});
  file.root["skins"][0]["joints"] = {other, bone};
  file.root["skins"][0]["inverseBindMatrices"] =
      file.add_accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                           1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -5, 0, 1},
                        "MAT4");
  check({2, 5, 0});
}

TEST_CASE(
    "joints have names that differ: their own, with a number where it is taken, or their node's number") {
  GltfBuilder file = skinned_tetrahedron();
  std::vector<int> joints = {1};
  for (const char* name : {"bone", "bone", "bone (2)", ""})
    joints.push_back(file.add_node({{"name", name}}, 1));
  joints.push_back(file.add_node(json::object(), 1));
  file.root["skins"][0]["joints"] = joints;
  const auto bytes = file.glb();
  const auto rig = read_gltf_rig(bytes, read_gltf_memory(bytes).primitives);
  REQUIRE(rig.has_value());
  std::vector<std::string> names;
  for (const Joint& joint : rig->joints) names.push_back(joint.name);
  CHECK(names ==
        std::vector<std::string>{"bone", "bone (2)", "bone (3)", "bone (2) (2)", "joint5", "joint6"});
  for (size_t j = 0; j < joints.size(); ++j) CHECK(rig->joints[j].node == joints[j]);
}

TEST_CASE("empty parts are refused, or left out with a warning") {
  GltfBuilder file = tetrahedron();
  file.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 0}});
  file.add("accessors", {{"componentType", 5125}, {"type", "SCALAR"}, {"count", 0}});
  json& primitives = file.root["meshes"][0]["primitives"];
  primitives.push_back({{"attributes", {{"POSITION", 2}}}, {"indices", 3}});
  primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"indices", 3}});
  file.root["meshes"].push_back({{"name", "none"}, {"primitives", json::array()}});
  file.root["meshes"].push_back({{"name", "nothing"}});
  file.add_node({{"mesh", 1}});
  file.add_node({{"mesh", 2}});
  CHECK(error_of(file.glb()).find("lenient") != std::string::npos);
  const GltfMesh mesh = read_gltf_memory(file.glb(), {.limits = {}, .lenient = true});
  CHECK(mesh.mesh.vertex_count() == 4);
  CHECK(mesh.primitives.size() == 1);
  CHECK(mentions(mesh.warnings, "2 empty primitives"));
  CHECK(mentions(mesh.warnings, "2 meshes without primitives"));
}
