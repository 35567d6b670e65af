// VRM 1.0: the humanoid map names the nodes of the joints, meta data is checked, everything else stays.
#include "base/error.h"
#include "gltf/small_skin.h"

using namespace focal;
using namespace focal_test;

namespace {

const std::vector<std::string> bones = {"hips",          "spine",         "head",          "leftUpperLeg",
                                        "leftLowerLeg",  "leftFoot",      "rightUpperLeg", "rightLowerLeg",
                                        "rightFoot",     "leftUpperArm",  "leftLowerArm",  "leftHand",
                                        "rightUpperArm", "rightLowerArm", "rightHand"};
constexpr const char* meta = R"({"name":"Ann","authors":["Bob"],"allowRedistribution":true})";

Rig avatar(size_t vertices) {
  Rig rig;
  for (size_t j = 0; j < bones.size(); ++j)
    rig.joints.push_back({"joint " + std::to_string(j), j == 0 ? -1 : 0,
                          place(0, {0, 0, 1}, {0, 0.1 * static_cast<double>(j), 0})});
  rig.joints.push_back({"tail", 0, place(0, {0, 0, 1}, {0, 0, 1})});
  rig.influences.assign(vertices, {{{0, 1}}});
  return rig;
}

std::vector<std::byte> add_vrm(std::span<const std::byte> bytes, const std::vector<Joint>& joints,
                               const std::vector<std::string>& all, std::string_view data) {
  GltfDocument document(copy_of(bytes));
  document.add_vrm(joints, all, data);
  return document.bytes();
}

std::vector<std::string> roles() {
  auto result = bones;
  result.emplace_back();  // of the tail
  return result;
}

}  // namespace

TEST_CASE("bones name the nodes of their joints, the license is filled in") {
  GltfBuilder file = tetrahedron();
  file.root["extensions"] = {{"OTHER", {{"kept", true}}}};
  const auto source = file.glb();
  const Rig rig = avatar(4);
  const auto skinned =
      focal_test::add_skin(source, focal_test::read_gltf_memory(source).primitives, {&rig, {}});
  const json root = parsed(add_vrm(skinned, rig.joints, roles(), meta));
  const json& vrm = root["extensions"]["VRMC_vrm"];
  CHECK(vrm["specVersion"] == "1.0");
  CHECK(vrm["meta"]["name"] == "Ann");
  CHECK(vrm["meta"]["allowRedistribution"] == true);
  CHECK(vrm["meta"]["licenseUrl"] == "https://vrm.dev/licenses/1.0/");
  CHECK(vrm["humanoid"]["humanBones"].size() == bones.size());
  for (size_t j = 0; j < bones.size(); ++j) {
    const auto node = vrm["humanoid"]["humanBones"][bones[j]]["node"].get<size_t>();
    CHECK(root["nodes"][node]["name"] == "joint " + std::to_string(j));
  }
  CHECK(root["extensions"]["OTHER"]["kept"] == true);
  CHECK(root["extensionsUsed"] == json::array({"VRMC_vrm"}));
  CHECK(root["meshes"] == parsed(skinned)["meshes"]);
  // Once more: replaced, declared once.
  const json again = parsed(add_vrm(add_vrm(skinned, rig.joints, roles(), meta), rig.joints, roles(),
                                    R"({"name":"Eve","authors":["Bob"],"licenseUrl":"https://x"})"));
  CHECK(again["extensionsUsed"].size() == 1);
  CHECK(again["extensions"]["VRMC_vrm"]["meta"]["licenseUrl"] == "https://x");
}

TEST_CASE("what VRM requires is required") {
  const auto source = tetrahedron().glb();
  const Rig rig = avatar(4);
  const auto skinned =
      focal_test::add_skin(source, focal_test::read_gltf_memory(source).primitives, {&rig, {}});
  auto fewer = roles();
  fewer[5] = "";
  CHECK_THROWS_WITH_AS(add_vrm(skinned, rig.joints, fewer, meta),
                       "the skeleton has no joint for leftFoot, which VRM requires", Error);
  for (const char* wrong :
       {"{}", R"({"name":"","authors":["Bob"]})", R"({"name":"Ann"})", R"({"name":"Ann","authors":[]})",
        R"({"name":"Ann","authors":[3]})", R"({"name":"Ann","authors":"Bob"})"})
    CHECK_THROWS_WITH_AS(add_vrm(skinned, rig.joints, roles(), wrong),
                         "VRM's meta data needs a name and a list of authors", Error);
  CHECK_THROWS_AS(add_vrm(skinned, rig.joints, roles(), "[]"), Error);
  CHECK_THROWS_AS(add_vrm(skinned, rig.joints, roles(), "{"), Error);
  CHECK_THROWS_WITH_AS(add_vrm(source, rig.joints, roles(), meta),
                       "the file lacks the joints of the skeleton", Error);
}
