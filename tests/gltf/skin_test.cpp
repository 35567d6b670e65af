// Skeletons and weights go into the caller's file and come back the same; what is wrong with a skin is said.
#include "gltf/skin.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <limits>
#include <numbers>

#include "base/atomic_file.h"
#include "base/error.h"
#include "evaluation_data.h"
#include "gltf/gltf_builder.h"
#include "gltf/preflight.h"
#include "gltf/writer.h"

using namespace focal;
using namespace focal_test;

namespace {

Matrix4 place(double angle, const Vector3& axis, const Vector3& at) {
  Matrix4 result = Matrix4::Identity();
  result.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  result.topRightCorner<3, 1>() = at;
  return result;
}

Rig two_joints(size_t vertices) {
  Rig rig;
  rig.joints = {{"root", -1, place(0.3, {1, 2, 3}, {0, 0, 0.5})},
                {"tip \"x\"", 0, place(1, {0, 1, 0}, {1, 0, 0})}};
  for (size_t v = 0; v < vertices; ++v)
    rig.influences.push_back(v == 0 ? VertexInfluences{{{1, 1}}}
                                    : VertexInfluences{{{0, 0.75F}, {1, 0.25F}}});
  return rig;
}

std::vector<Vector3> tips() { return {{0, 0, 1}, {2, 0, 0}}; }

void check_same(const Rig& a, const Rig& b) {
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
Rig through_file(const std::vector<std::byte>& source, std::vector<std::byte>* written = nullptr) {
  const GltfMesh mesh = read_gltf_memory(source);
  const Rig rig = two_joints(static_cast<size_t>(mesh.mesh.vertex_count()));
  const auto result = add_skin(source, mesh.primitives, {&rig, tips(), {}, {}, &mesh.mesh});
  const GltfMesh again = read_gltf_memory(result);
  CHECK((again.mesh.positions - mesh.mesh.positions).norm() < 1e-5);
  const auto read = read_gltf_rig(result, again.primitives);
  REQUIRE(read.has_value());
  check_same(*read, rig);
  if (written) *written = result;
  return *read;
}

json parsed(std::span<const std::byte> bytes) {
  const auto text = open_container(bytes, {}).json;
  return json::parse(reinterpret_cast<const char*>(text.data()),
                     reinterpret_cast<const char*>(text.data()) + text.size());
}

// A tetrahedron moved by one joint, with what the arguments change.
GltfBuilder skinned_tetrahedron(uint8_t joint = 0, float weight = 1) {
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

}  // namespace

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

TEST_CASE("a mesh with a place or a parent goes to a root of its own, and stays where it is") {
  GltfBuilder file = tetrahedron();
  file.root["nodes"][0]["translation"] = {1, 2, 3};
  file.root["nodes"][0]["rotation"] = {0, std::numbers::sqrt2 / 2, 0, std::numbers::sqrt2 / 2};
  file.root["nodes"][0]["scale"] = {2, 2, 2};
  file.root["nodes"][0]["name"] = "body";
  file.add_mesh(0, 1);
  file.add_node({{"mesh", 1}}, 0);
  std::vector<std::byte> written;
  through_file(file.glb(), &written);
  const json root = parsed(written);
  CHECK_FALSE(root["nodes"][0].contains("mesh"));
  CHECK(root["nodes"][0]["name"] == "body");
  size_t skinned = 0;
  for (const auto& node : root["nodes"]) {
    if (!node.contains("skin")) continue;
    ++skinned;
    CHECK_FALSE(node.contains("translation"));
  }
  CHECK(skinned == 2);
}

TEST_CASE("further instances of a mesh keep it without the skin") {
  GltfBuilder file = tetrahedron();
  file.add_node({{"mesh", 0}, {"translation", {5, 0, 0}}});
  const auto source = file.glb();
  const Rig rig = two_joints(4);
  const auto written = add_skin(source, read_gltf_memory(source).primitives, {&rig, tips()});
  const json root = parsed(written);
  REQUIRE(root["meshes"].size() == 2);
  CHECK(root["nodes"][1]["mesh"] == 1);
  CHECK_FALSE(root["meshes"][1]["primitives"][0]["attributes"].contains("JOINTS_0"));
  CHECK(read_gltf_memory(written).mesh.vertex_count() == 8);
}

TEST_CASE("a .gltf gets its data as a URI, a .glb in its chunk, everything else stays") {
  GltfBuilder file = tetrahedron();
  file.root["extras"] = {{"big", 18446744073709551615u}, {"nothing", nullptr}};
  const auto glb = file.glb();
  std::vector<std::byte> written;
  through_file(glb, &written);
  const auto before = open_container(glb, {}).bin, after = open_container(written, {}).bin;
  CHECK(after.size() > before.size());
  CHECK(std::equal(before.begin(), before.end(), after.begin()));
  CHECK(parsed(written)["extras"] == file.root["extras"]);

  std::string uri = "data:application/octet-stream;base64,";
  for (size_t i = 0; i < file.bin.size(); i += 3) {  // an encoder of its own
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k)
      group = group * 256 + (i + k < file.bin.size() ? std::to_integer<uint32_t>(file.bin[i + k]) : 0);
    for (int shift = 18, k = 0; shift >= 0; shift -= 6, ++k)
      uri += i + static_cast<size_t>(k) > file.bin.size() ? '=' : digits[group >> shift & 63];
  }
  through_file(file.gltf(uri), &written);
  CHECK(parsed(written)["buffers"].size() == 2);
}

TEST_CASE("a character's own skin makes way") {
  std::vector<std::byte> written;
  through_file(skinned_tetrahedron().glb(), &written);
  const json root = parsed(written);
  CHECK(root["skins"].size() == 2);
  CHECK(root["nodes"][0]["skin"] == 1);
}

TEST_CASE("a second call replaces the skeleton of the first, with its animations") {
  std::vector<std::byte> once, twice;
  through_file(tetrahedron().glb(), &once);
  {
    const Rig rig = two_joints(4);
    const GltfMesh mesh = read_gltf_memory(once);
    JointAnimation wave{"wave", {0, 1}, std::vector<JointKeys>(2)};
    wave.joints[1].translation = {{0, 0, 0}, {0, 1, 0}};
    once = add_skin(once, mesh.primitives, {&rig, tips(), {}, {wave}, &mesh.mesh});
  }
  const json before = parsed(once);
  CHECK(before["animations"].size() == 1);
  CHECK(before["nodes"].size() == 5);  // mesh, group, two joints, a tip
  through_file(once, &twice);
  const json after = parsed(twice);
  CHECK(after["nodes"].size() == before["nodes"].size());
  CHECK(after["scenes"][0]["nodes"].size() == 2);
  CHECK(after["skins"].size() == 1);
  CHECK_FALSE(after.contains("animations"));
}

TEST_CASE("a skeleton to which the user has hung a sword stays") {
  std::vector<std::byte> written;
  through_file(tetrahedron().glb(), &written);
  json root = parsed(written);
  const auto bone = root["skins"][0]["joints"][1].get<size_t>();
  root["meshes"].push_back(root["meshes"][0]);
  root["meshes"][1]["primitives"][0]["attributes"].erase("JOINTS_0");
  root["meshes"][1]["primitives"][0]["attributes"].erase("WEIGHTS_0");
  root["nodes"].push_back({{"name", "sword"}, {"mesh", 1}});
  root["nodes"][bone]["children"].push_back(root["nodes"].size() - 1);
  const auto bin = open_container(written, {}).bin;
  const auto armed = glb_bytes(root.dump(), bin_chunk(bin));
  const GltfMesh mesh = read_gltf_memory(armed);
  const Rig rig = two_joints(8);
  const json after = parsed(add_skin(armed, mesh.primitives, {&rig, tips(), {}, {}, &mesh.mesh}));
  CHECK(after["nodes"][bone]["name"] == root["nodes"][bone]["name"]);
  CHECK(after["skins"].size() == 3);  // the old one, and one for each place of a mesh
}

TEST_CASE("a mesh that its node mirrors stays right side out") {
  GltfBuilder file = tetrahedron();
  file.root["nodes"][0]["scale"] = {-2, 2, 2};
  const auto source = file.glb();
  std::vector<std::byte> written;
  through_file(source, &written);
  const GltfMesh before = read_gltf_memory(source), after = read_gltf_memory(written);
  CHECK(before.primitives[0].mirrored);
  CHECK_FALSE(after.primitives[0].mirrored);
  CHECK(after.mesh.triangles == before.mesh.triangles);  // counter-clockwise from outside in both
  const Rig rig = two_joints(4);
  CHECK_THROWS_AS(add_skin(source, before.primitives, {&rig, {}}), Error);  // without the triangles
}

TEST_CASE("animations of the file keep their names and their nodes") {
  GltfBuilder file = tetrahedron();
  const int times = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  const int places = file.add_accessor(std::vector<float>{0, 0, 0, 0, 1, 0}, "VEC3");
  file.root["animations"] =
      json::array({{{"name", "wave"},
                    {"samplers", {{{"input", times}, {"output", places}}}},
                    {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}},
                   {{"name", 7}, {"channels", "none"}}});  // what is malformed is carried through
  const auto source = file.glb();
  const GltfMesh mesh = read_gltf_memory(source);
  const Rig rig = two_joints(4);
  JointAnimation wave{"wave", {0, 1}, std::vector<JointKeys>(2)};
  wave.joints[1].translation = {{0, 0, 0}, {0, 1, 0}};
  const json root = parsed(add_skin(source, mesh.primitives, {&rig, tips(), {}, {wave}, &mesh.mesh}));
  REQUIRE(root["animations"].size() == 3);
  CHECK(root["animations"][0] == file.root["animations"][0]);
  CHECK(root["animations"][2]["name"] == "wave (2)");
  CHECK_FALSE(root["nodes"][0].contains(
      "skin"));  // glTF ignores the place of a node with a skin: it would stop moving
}

TEST_CASE("animations of any form are carried through, and one of weights alone does not move a node") {
  GltfBuilder file = tetrahedron();
  file.root["animations"] = json::parse(R"([{}, {"channels": "none"}, {"channels": [{}, {"target": {}},
      {"target": {"node": "x", "path": 3}}, {"target": {"node": 0, "path": "weights"}}]}])");
  std::vector<std::byte> written;
  through_file(file.glb(), &written);
  const json root = parsed(written);
  CHECK(root["animations"] == file.root["animations"]);
  CHECK(root["nodes"][0]["skin"] == 0);
  file.root["animations"] = "none";
  through_file(file.glb(), &written);
  CHECK(parsed(written)["animations"] == "none");
}

TEST_CASE("a .glb without a BIN chunk gets one") {
  GltfBuilder file;
  file.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}});  // zeros, without a view
  file.add_mesh(0);
  file.add_node({{"mesh", 0}});
  std::vector<std::byte> written;
  through_file(file.glb(), &written);
  CHECK(open_container(written, {}).has_bin);
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
    const auto none = read_gltf_rig(bytes, read_gltf_memory(bytes).primitives, {}, std::nullopt, &invalid);
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
                         "joints or weights of a primitive are not four a vertex", Error);
  }
  const auto bytes = skinned_tetrahedron().glb();
  auto primitives = read_gltf_memory(bytes).primitives;
  primitives[0].vertex_count = 5;  // of another file
  CHECK_THROWS_WITH_AS(read_gltf_rig(bytes, primitives),
                       "joints or weights of a primitive are not four a vertex", Error);
  GltfBuilder bare = tetrahedron();
  bare.root.erase("nodes"), bare.root.erase("scenes"), bare.root.erase("scene");
  const auto without_nodes = bare.glb();
  CHECK_FALSE(read_gltf_rig(without_nodes, read_gltf_memory(without_nodes).primitives).has_value());
}

TEST_CASE("what only looks like an earlier skeleton of ours stays") {
  const auto rigged_once = [](const json& changes) {  // changes: of the skeleton's top node
    std::vector<std::byte> written;
    through_file(tetrahedron().glb(), &written);
    json root = parsed(written);
    const auto top = root["scenes"][0]["nodes"][0].get<size_t>();
    root["nodes"][top].merge_patch(changes);
    if (changes.contains("camera")) root["cameras"] = {{{"type", "perspective"}}};
    const auto again = glb_bytes(root.dump(), bin_chunk(open_container(written, {}).bin));
    const GltfMesh mesh = read_gltf_memory(again);
    const Rig rig = two_joints(4);
    const json after = parsed(add_skin(again, mesh.primitives, {&rig, {}, {}, {}, &mesh.mesh}));
    return after["scenes"][0]["nodes"]
        .size();  // the mesh, the new skeleton, and the former one where it stays
  };
  CHECK(rigged_once(json::object()) == 2);
  CHECK(rigged_once({{"name", "my_skeleton"}}) == 3);
  CHECK(rigged_once({{"name", nullptr}}) == 3);
  CHECK(rigged_once({{"extras", nullptr}}) == 3);
  CHECK(rigged_once({{"camera", 0}}) == 3);
  CHECK(rigged_once({{"extensions", {{"x", 1}}}}) == 3);
  CHECK(rigged_once({{"mesh", 0}}) == 3);
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
  CHECK(error_of_rig(lost) == "joint \"tip \\\"x\\\"\" is not finite");
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
