// Which nodes of a file are read, and which of them belong to a character.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "gltf/gltf_builder.h"

using namespace focal;
using namespace focal_test;

namespace {

json visibility(bool visible) { return {{"KHR_node_visibility", {{"visible", visible}}}}; }

// A tetrahedron at a root node, one at a child of a node without a mesh, and a third below that child.
GltfBuilder family_of_three() {
  GltfBuilder file = tetrahedron();
  const int group = file.add_node({{"name", "group"}});
  file.add_mesh(0, 1), file.add_mesh(0, 1);
  const int child = file.add_node({{"name", "child"}, {"mesh", 1}}, group);
  file.add_node({{"mesh", 2}}, child);
  return file;
}

std::vector<std::string> names_read(const GltfBuilder& file, bool hidden_too = false) {
  std::vector<std::string> names;
  GltfReadParams how;
  how.hidden_too = hidden_too;
  for (const MeshPiece& piece : read_gltf_memory(file.glb(), how).pieces) names.push_back(piece.name);
  return names;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("hidden nodes are not read, nor what is below them") {
  GltfBuilder file = family_of_three();
  CHECK(names_read(file) == Names{"node 0", "node 'child'", "node 3"});
  file.root["nodes"][1]["extensions"] = visibility(false);
  const GltfMesh mesh = read_gltf_memory(file.glb());
  CHECK(names_read(file) == Names{"node 0"});
  CHECK(mesh.mesh.vertex_count() == 4);
  CHECK(mesh.hidden == Names{"node 'child'", "node 3"});
  REQUIRE(mesh.warnings.size() == 2);
  CHECK(mesh.warnings[0].find("node 'child', which KHR_node_visibility hides") != std::string::npos);
  CHECK(names_read(file, true) == Names{"node 0", "node 'child'", "node 3"});
}

TEST_CASE("a child cannot be shown where a node above it is hidden") {
  GltfBuilder file = family_of_three();
  file.root["nodes"][1]["extensions"] = visibility(false);
  file.root["nodes"][2]["extensions"] = visibility(true);
  CHECK(names_read(file) == Names{"node 0"});
  file.root["nodes"][1]["extensions"] = visibility(true);
  file.root["nodes"][3]["extensions"] = visibility(false);
  CHECK(names_read(file) == Names{"node 0", "node 'child'"});
}

TEST_CASE("a mesh that a hidden and a shown node have comes as the shown one has it") {
  GltfBuilder file = tetrahedron();
  file.root["nodes"][0]["extensions"] = visibility(false);
  file.add_node({{"mesh", 0}, {"translation", {5, 0, 0}}});
  const GltfMesh mesh = read_gltf_memory(file.glb());
  CHECK(mesh.primitives[0].node == 1);
  CHECK(mesh.mesh.positions(0, 0) == 5);
}

TEST_CASE("where all is hidden, all of it is read, with a warning") {
  GltfBuilder file = family_of_three();
  for (const size_t node : {0, 1}) file.root["nodes"][node]["extensions"] = visibility(false);
  const GltfMesh mesh = read_gltf_memory(file.glb());
  CHECK(mesh.pieces.size() == 3);
  CHECK(mesh.hidden.empty());
  REQUIRE(mesh.warnings.size() == 1);
  CHECK(mesh.warnings[0].starts_with("KHR_node_visibility hides every mesh"));
}

TEST_CASE("KHR_node_visibility may be required, and must be well formed") {
  GltfBuilder file = tetrahedron();
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_node_visibility"};
  file.root["nodes"][0]["extensions"] = {{"KHR_node_visibility", json::object()}};  // the default is visible
  CHECK(error_of(file.glb()) == "");
  CHECK(read_gltf_memory(file.glb()).warnings.empty());
  file.root["nodes"][0]["extensions"] = {{"KHR_node_visibility", {{"visible", 0}}}};
  CHECK(error_of(file.glb()).find("nodes[0].extensions") != std::string::npos);
}

TEST_CASE("what has a skin or hangs on a joint is character") {
  GltfBuilder file = tetrahedron();
  file.add_mesh(0, 1), file.add_mesh(0, 1);
  const int bone = file.add_node({{"name", "bone"}});
  const int hand = file.add_node({{"name", "hand"}}, bone);
  file.add_node({{"name", "sword"}, {"mesh", 1}}, hand);
  file.add_node({{"name", "ground"}, {"mesh", 2}});
  file.root["skins"] = json::array({{{"joints", {bone}}}});
  file.root["nodes"][0]["skin"] = 0;
  const GltfMesh mesh = read_gltf_memory(file.glb());
  REQUIRE(mesh.pieces.size() == 3);
  CHECK(mesh.pieces[0].is_character);
  CHECK(mesh.pieces[1].is_character);
  CHECK_FALSE(mesh.pieces[2].is_character);
  CHECK(mesh.pieces[2].name == "node 'ground'");
  CHECK(mesh.pieces[2].first_triangle == 8);
  CHECK(mesh.pieces[2].triangle_count == 4);
}
