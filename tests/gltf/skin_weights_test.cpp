// Other weights for the skins of a file: joints stay, each primitive's weights are in the numbers of its own skin.
#include "gltf/small_skin.h"

using namespace focal;
using namespace focal_test;

namespace {

// Two tetrahedra on one chain of three bones: the first skin has all of them, last first; the second lacks the middle one.
GltfBuilder two_skins() {
  GltfBuilder file = skinned_tetrahedron();
  const size_t root = file.root["skins"][0]["joints"][0];
  const int middle = file.add_node({{"name", "middle"}}, static_cast<int>(root));
  const int end = file.add_node({{"name", "end"}}, middle);
  file.root["skins"] = json::array({{{"joints", {end, middle, root}}}, {{"joints", {root, end}}}});
  const auto attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  file.add_mesh(0, 1);
  file.root["meshes"][1]["primitives"][0]["attributes"]["JOINTS_0"] = attributes["JOINTS_0"];
  file.root["meshes"][1]["primitives"][0]["attributes"]["WEIGHTS_0"] = attributes["WEIGHTS_0"];
  file.add_node({{"mesh", 1}, {"skin", 1}});
  return file;
}

std::vector<std::byte> replace_weights(std::span<const std::byte> bytes,
                                       std::span<const GltfPrimitive> primitives, const Rig& rig) {
  GltfDocument document(copy_of(bytes));
  document.replace_weights(primitives, rig);
  return document.bytes();
}

int32_t number_of(const Rig& rig, const std::string& name) {
  for (size_t j = 0; j < rig.joints.size(); ++j)
    if (rig.joints[j].name == name) return static_cast<int32_t>(j);
  return -1;
}

}  // namespace

TEST_CASE("weights change, nodes, skins and all other data stay") {
  GltfBuilder file = two_skins();
  const auto source = file.glb();
  const auto primitives = focal_test::read_gltf_memory(source).primitives;
  Rig rig = *focal_test::read_gltf_rig(source, primitives);
  REQUIRE(rig.joints.size() == 3);
  const int32_t root = number_of(rig, "bone"), middle = number_of(rig, "middle"), end = number_of(rig, "end");
  for (VertexInfluences& one : rig.influences) one = {{{end, 0.75F}, {middle, 0.25F}}};
  const auto written = replace_weights(source, primitives, rig);
  const json before = parsed(source), after = parsed(written);
  for (const char* kept : {"nodes", "skins", "scenes"}) CHECK(before[kept] == after[kept]);
  const auto old_bin = open_container(source, {}).bin, new_bin = open_container(written, {}).bin;
  CHECK(std::equal(old_bin.begin(), old_bin.begin() + before["buffers"][0]["byteLength"].get<int>(),
                   new_bin.begin()));

  const auto again = focal_test::read_gltf_rig(written, focal_test::read_gltf_memory(written).primitives);
  REQUIRE(again);
  REQUIRE(again->influences.size() == 8);
  for (size_t v = 0; v < 8; ++v) {
    CHECK(again->influences[v][0].joint == end);
    CHECK(again->influences[v][0].weight == doctest::Approx(0.75F));
    // The second skin lacks the middle bone: the one above it takes its share.
    CHECK(again->influences[v][1].joint == (v < 4 ? middle : root));
    CHECK(again->influences[v][1].weight == doctest::Approx(0.25F));
  }
}

TEST_CASE("a mesh without a skin and one of scenery keep what they have") {
  GltfBuilder file = two_skins();
  file.root["nodes"].back().erase("skin");
  const auto source = file.glb();
  auto primitives = focal_test::read_gltf_memory(source).primitives;
  Rig rig = *focal_test::read_gltf_rig(source, primitives);
  const auto second = parsed(source)["meshes"][1];
  CHECK(parsed(replace_weights(source, primitives, rig))["meshes"][1] == second);
  primitives[0].is_scenery = true;
  CHECK(parsed(replace_weights(source, primitives, rig))["meshes"] == parsed(source)["meshes"]);
}

TEST_CASE("a mesh whose bind matrices make no shape stands where it stood with whatever weights") {
  GltfBuilder file = segments();
  file.add_node({{"name", "hidden"},
                 {"mesh", file.add_mesh(0, 1)},
                 {"skin", 0},
                 {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  file.root["extensionsUsed"] = {"KHR_node_visibility"};
  const auto source = file.glb();
  const GltfMesh mesh = read_gltf_memory(source);
  Rig rig = *read_gltf_rig(source, mesh.primitives);
  for (VertexInfluences& one : rig.influences) one = {{{0, 0.5F}, {1, 0.5F}}};
  const auto written = replace_weights(source, mesh.primitives, rig);
  const GltfMesh again = read_gltf_memory(written);
  CHECK((again.mesh.positions - mesh.mesh.positions).norm() < 1e-5);
  CHECK_FALSE(again.primitives[0].is_posed);
  check_same(*read_gltf_rig(written, again.primitives), rig);
  const json before = parsed(source), after = parsed(written);
  CHECK(after["nodes"].back() == before["nodes"].back());  // it keeps its skin
  CHECK(after["skins"][0] == before["skins"][0]);
  CHECK(after["skins"].size() == 2);
}
