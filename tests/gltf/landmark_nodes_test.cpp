// Landmarks go into the caller's file and nothing else changes; proved by taking them out again and comparing.
#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "base/atomic_file.h"
#include "base/error.h"
#include "evaluation_data.h"
#include "gltf/document.h"
#include "gltf/gltf_builder.h"
#include "gltf/preflight.h"

using namespace focal;
using namespace focal_test;

namespace {

using Ordered = nlohmann::ordered_json;

Ordered in_order(std::span<const std::byte> bytes) {
  const auto text = open_container(bytes, {}).json;
  return Ordered::parse(reinterpret_cast<const char*>(text.data()),
                        reinterpret_cast<const char*>(text.data()) + text.size());
}

std::vector<GltfLandmark> three_landmarks() {
  return {{"nose", {2, {0.2, 0.3, 0.5}}, {0.1, 0.2, 0.3}, 0.75, LandmarkStatus::found},
          {"tail \"x\"", {0, {1, 0, 0}}, {-1, 0, 1e-5}, 0.25, LandmarkStatus::uncertain},
          {"wing", {}, {}, 0, LandmarkStatus::absent}};
}

// Removes what add_landmarks adds to a file that had none before.
Ordered without_landmarks(Ordered root) {
  auto& nodes = root["nodes"];
  const auto is_new = [](const Ordered& node) {
    return node.contains("extras") && node["extras"].contains("focal");
  };
  while (!nodes.empty() && is_new(nodes.back())) nodes.erase(nodes.size() - 1);
  for (auto& scene : root["scenes"]) {
    auto& roots = scene["nodes"];
    while (!roots.empty() && roots.back() >= nodes.size()) roots.erase(roots.size() - 1);
  }
  for (auto& mesh : root["meshes"])
    if (mesh.contains("extras") && mesh["extras"].is_object()) {
      mesh["extras"].erase("focal");
      if (mesh["extras"].empty()) mesh.erase("extras");
    }
  return root;
}

bool same_bytes(std::span<const std::byte> a, std::span<const std::byte> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

TEST_CASE("landmarks become named nodes in the scene and extras of their mesh") {
  const auto source = tetrahedron().glb();
  const auto mesh = read_gltf_memory(source);
  const auto result = add_landmarks(source, mesh.primitives, three_landmarks());
  const Ordered root = in_order(result);
  const auto group = root["scenes"][0]["nodes"].back().get<size_t>();
  CHECK(root["nodes"][group]["name"] == "focal_landmarks");
  const auto& children = root["nodes"][group]["children"];
  REQUIRE(children.size() == 2);  // the absent one has no place
  const auto& nose = root["nodes"][children[0].get<size_t>()];
  CHECK(nose["name"] == "nose");
  CHECK(nose["translation"].dump() == "[0.1,0.2,0.3]");
  CHECK(nose["extras"]["focal"]["confidence"] == 0.75);
  const auto& focal = root["meshes"][0]["extras"]["focal"];
  CHECK(focal["version"] == 1);
  REQUIRE(focal["landmarks"].size() == 3);
  CHECK(focal["landmarks"][0]["triangle"] == 2);
  CHECK(focal["landmarks"][0]["barycentric"].dump() == "[0.2,0.3,0.5]");
  CHECK(focal["landmarks"][1]["name"] == "tail \"x\"");
  CHECK(focal["landmarks"][2]["status"] == "absent");
  CHECK_FALSE(focal["landmarks"][2].contains("triangle"));
  CHECK(read_gltf_memory(result).mesh.positions == mesh.mesh.positions);
}

TEST_CASE("everything else in the file stays as it was") {
  GltfBuilder file = tetrahedron();
  file.root["extras"] = {{"big", 18446744073709551615u}, {"nothing", nullptr}, {"tenth", 0.1}, {"one", 1.0}};
  file.root["meshes"][0]["extras"] = {{"kept", json::array({1, json::object(), nullptr})}};
  file.root["images"] = json::array({{{"uri", "picture.png"}}});
  file.root["unknown"] = {{"z", 1}, {"a", 2}};
  const auto glb = file.glb();
  const auto with = add_landmarks(glb, read_gltf_memory(glb).primitives, three_landmarks());
  CHECK(without_landmarks(in_order(with)).dump() == in_order(glb).dump());
  CHECK(same_bytes(open_container(with, {}).rest, open_container(glb, {}).rest));

  const auto gltf = file.gltf("data:application/octet-stream;base64,AAAA");
  const auto text = add_landmarks(gltf, {}, {});
  CHECK(text.front() == std::byte('{'));
  CHECK(without_landmarks(in_order(text)).dump() == in_order(gltf).dump());
}

TEST_CASE("a second call replaces the landmarks of the first") {
  const auto source = tetrahedron().glb();
  const auto primitives = read_gltf_memory(source).primitives;
  const auto once = add_landmarks(source, primitives, three_landmarks());
  CHECK(add_landmarks(once, primitives, three_landmarks()) == once);
  const auto emptied = add_landmarks(once, primitives, {});
  const Ordered root = in_order(emptied);
  CHECK(root["meshes"][0]["extras"]["focal"]["landmarks"].empty());
  CHECK(root["scenes"][0]["nodes"].size() == 2);

  // A node the user hung below the group keeps the whole group.
  Ordered edited = in_order(once);
  edited["nodes"].push_back({{"name", "mine"}});
  edited["nodes"][edited["scenes"][0]["nodes"].back().get<size_t>()]["children"].push_back(
      edited["nodes"].size() - 1);
  const auto third = add_landmarks(bytes_of(edited.dump()), primitives, three_landmarks());
  CHECK(in_order(third)["scenes"][0]["nodes"].size() == 3);
}

TEST_CASE("files without scenes, nodes or object extras take landmarks too") {
  for (const char* gone : {"scenes", "nodes"}) {
    GltfBuilder file = tetrahedron();
    file.root.erase("scene");
    file.root.erase("scenes");
    file.root.erase(gone);
    const auto source = file.glb();
    const auto primitives = read_gltf_memory(source).primitives;
    const auto result = add_landmarks(source, primitives, three_landmarks());
    CHECK(read_gltf_memory(result).mesh.vertex_count() == 4);
    CHECK(in_order(result)["scenes"][0]["nodes"].size() == (std::string(gone) == "nodes" ? 1 : 2));
  }
  GltfBuilder file = tetrahedron();
  file.root["meshes"][0]["extras"] = 7;
  const auto source = file.glb();
  const auto result = add_landmarks(source, read_gltf_memory(source).primitives, three_landmarks());
  CHECK(in_order(result)["meshes"][0]["extras"] == 7);
}

TEST_CASE("a document that has to grow while it is edited") {  // its members move in memory then
  for (int more = 0; more < 12; ++more) {
    GltfBuilder file = tetrahedron();
    for (const char* gone : {"scene", "scenes", "nodes"}) file.root.erase(gone);
    for (int i = 0; i < more; ++i) file.root["extra" + std::to_string(i)] = i;
    const auto source = file.glb();
    const auto result = add_landmarks(source, read_gltf_memory(source).primitives, three_landmarks());
    CHECK(in_order(result)["scenes"][0]["nodes"].size() == 1);
    CHECK(in_order(result)["nodes"].size() == 3);
  }
}

TEST_CASE("the second mesh's triangles are counted from its own, a mirrored one's corners turned back") {
  GltfBuilder file = tetrahedron();
  file.add_mesh(0, 1);
  file.add_node({{"mesh", 1}, {"scale", {-1, 1, 1}}});
  const auto source = file.glb();
  const std::vector<GltfLandmark> landmarks = {
      {"a", {5, {0.5, 0.25, 0.125}}, {0, 0, 0}, 1, LandmarkStatus::found}};
  const Ordered root = in_order(add_landmarks(source, read_gltf_memory(source).primitives, landmarks));
  CHECK_FALSE(root["meshes"][0].contains("extras"));
  const auto& landmark = root["meshes"][1]["extras"]["focal"]["landmarks"][0];
  CHECK(landmark["triangle"] == 1);
  CHECK(landmark["barycentric"].dump() == "[0.5,0.125,0.25]");
}

TEST_CASE("landmarks that cannot be placed are refused") {
  const auto source = tetrahedron().glb();
  const auto primitives = read_gltf_memory(source).primitives;
  auto landmarks = three_landmarks();
  landmarks[0].point.triangle = 4;
  CHECK_THROWS_AS(add_landmarks(source, primitives, landmarks), Error);
  landmarks = three_landmarks();
  landmarks[1].position.x() = 1e300;
  CHECK_THROWS_AS(add_landmarks(source, primitives, landmarks), Error);
}

TEST_CASE("a file without scenes gets one of its roots") {
  GltfBuilder file = tetrahedron();
  file.root.erase("scenes"), file.root.erase("scene");
  file.root["nodes"] = json::parse(R"([{"mesh": 0}, {"children": [0]}])");
  const auto source = file.glb();
  const Ordered root = in_order(add_landmarks(source, read_gltf_memory(source).primitives, {}));
  CHECK(root["scenes"][0]["nodes"] == Ordered({1, 2}));
}

TEST_CASE("landmarks to which the user has hung something of his own stay") {
  const auto source = tetrahedron().glb();
  const auto mesh = read_gltf_memory(source);
  const auto once = add_landmarks(source, mesh.primitives, three_landmarks());
  const auto group = in_order(once)["scenes"][0]["nodes"].back().get<size_t>();
  const auto nodes_after = [&](size_t node, const json& addition) {
    json root = json::parse(in_order(once).dump());
    root["nodes"][node].merge_patch(addition);
    root["nodes"].push_back({{"name", "mine"}});
    if (addition.contains("camera")) root["cameras"] = {{{"type", "perspective"}}};
    if (addition.contains("skin")) root["skins"] = {{{"joints", {group}}}};
    const auto bytes = glb_bytes(root.dump(), open_container(once, {}).rest);
    return in_order(add_landmarks(bytes, mesh.primitives, three_landmarks()))["scenes"][0]["nodes"].size();
  };
  CHECK(nodes_after(group, json::object()) == 2);  // the mesh and the new group
  const size_t mine = group + 3;
  for (const json& addition :
       {json{{"mesh", 0}}, json{{"camera", 0}}, json{{"skin", 0}}, json{{"extras", nullptr}}}) {
    CAPTURE(addition.dump());
    CHECK(nodes_after(group, addition) == 3);
    CHECK(nodes_after(group + 1, addition) == 3);
  }
  CHECK(nodes_after(group + 1, {{"children", {mine}}}) == 3);
}

TEST_CASE("a landmark of which a number is not finite is refused") {
  const auto source = tetrahedron().glb();
  const auto mesh = read_gltf_memory(source);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int which = 0; which < 4; ++which) {
    auto landmarks = three_landmarks();
    if (which == 0) landmarks[1].position.y() = nan;
    if (which == 1) landmarks[1].position.y() = 1e300;  // finite in double precision alone
    if (which == 2) landmarks[1].point.barycentric.z() = nan;
    if (which == 3) landmarks[1].confidence = nan;
    try {
      add_landmarks(source, mesh.primitives, landmarks);
      FAIL("it was written");
    } catch (const Error& error) {
      CHECK(error.status() == Status::invalid_landmark);
    }
  }
}

TEST_CASE("the rigged characters take landmarks and keep everything else") {
  const auto folder = evaluation_set("rigs");
  if (!folder) return;
  for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
    if (entry.path().extension() != ".glb") continue;
    CAPTURE(entry.path());
    const auto source = read_file(entry.path());
    const GltfMesh mesh = read_gltf_memory(source);
    const auto with = add_landmarks(source, mesh.primitives, three_landmarks());
    CHECK(without_landmarks(in_order(with)) == in_order(source));
    CHECK(same_bytes(open_container(with, {}).rest, open_container(source, {}).rest));
    CHECK(read_gltf_memory(with).mesh.positions == mesh.mesh.positions);
  }
}
