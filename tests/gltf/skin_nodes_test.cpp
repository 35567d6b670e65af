// What a new skeleton changes in the caller's document, and what it leaves alone.
#include <numbers>

#include "base/error.h"
#include "gltf/small_skin.h"

using namespace focal;
using namespace focal_test;

namespace {

JointAnimation moving_tip() {
  JointAnimation wave{"wave", std::vector<JointKeys>(2)};
  wave.joints[1].translation.times = {0, 1};
  wave.joints[1].translation.values = (RowMatrix(2, 3) << 0, 0, 0, 0, 1, 0).finished();
  return wave;
}

}  // namespace

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

TEST_CASE("each instance of a mesh gets a mesh and weights of its own; other scenes keep theirs") {
  GltfBuilder file = tetrahedron();
  file.add_node({{"mesh", 0}, {"translation", {5, 0, 0}}, {"scale", {-1, 1, 1}}});
  file.add("nodes", {{"mesh", 0}, {"name", "elsewhere"}});
  file.root["scenes"].push_back({{"nodes", {2}}});
  const auto source = file.glb();
  const GltfMesh mesh = read_gltf_memory(source);
  REQUIRE(mesh.primitives.size() == 2);
  CHECK(mesh.primitives[1].mirrored);
  Rig rig = two_joints(8);
  for (size_t v = 4; v < 8; ++v) rig.influences[v] = {{{1, 1}}};
  GltfDocument document(source);
  auto primitives = mesh.primitives;
  document.add_skin(primitives, {&rig, tips(), {}, {}, &mesh.mesh});
  const auto written = document.bytes();
  const json root = parsed(written);
  CHECK(root["meshes"].size() == 3);
  CHECK(primitives[1].mesh == 1);
  CHECK_FALSE(primitives[1].mirrored);
  const json& other = root["meshes"][root["nodes"][2]["mesh"].get<size_t>()];
  CHECK(other == file.root["meshes"][0]);
  const GltfMesh again = read_gltf_memory(written);
  CHECK((again.mesh.positions - mesh.mesh.positions).norm() < 1e-5);
  CHECK(again.mesh.triangles == mesh.mesh.triangles);
  const auto read = read_gltf_rig(written, again.primitives);
  REQUIRE(read.has_value());
  check_same(*read, rig);
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
    const JointAnimation wave = moving_tip();
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
  const JointAnimation wave = moving_tip();
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
    const Rig rig = two_joints(static_cast<size_t>(mesh.mesh.vertex_count()));
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

TEST_CASE("scenery keeps its node and its mesh, without a skin") {
  GltfBuilder file = tetrahedron();
  file.add_mesh(0, 1);
  file.add_node({{"name", "Ground"}, {"mesh", 1}, {"translation", {0, -1, 0}}});
  const auto source = file.glb();
  GltfMesh mesh = read_gltf_memory(source);
  mesh.primitives[1].is_scenery = true;
  const Rig rig = two_joints(8);
  const json root = parsed(add_skin(source, mesh.primitives, {&rig, tips(), {}, {}, &mesh.mesh}));
  CHECK(root["nodes"][0].contains("skin"));
  CHECK(root["nodes"][1] == file.root["nodes"][1]);
  CHECK(root["meshes"][1] == file.root["meshes"][1]);
}

TEST_CASE("what KHR_node_visibility hides keeps its node and its mesh") {
  GltfBuilder file = tetrahedron();
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_node_visibility"};
  file.add_node({{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  file.add_mesh(0, 1);
  file.add_node({{"mesh", 1}}, 1);
  std::vector<std::byte> written;
  const Rig rig = through_file(file.glb(), &written);
  CHECK(rig.influences.size() == 4);  // of the one mesh that is shown
  const json root = parsed(written);
  CHECK(root["extensionsRequired"] == file.root["extensionsRequired"]);
  CHECK(root["extensionsUsed"] == file.root["extensionsUsed"]);
  CHECK(root["nodes"][2] == file.root["nodes"][2]);
  CHECK(root["meshes"][1] == file.root["meshes"][1]);
  json hidden = root["nodes"][1];
  CHECK(hidden["mesh"] == 2);  // it showed the mesh that has a skin now: a copy without one
  CHECK(root["meshes"][2] == file.root["meshes"][0]);
  hidden["mesh"] = 0;
  CHECK(hidden == file.root["nodes"][1]);
}
