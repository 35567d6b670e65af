// What refers to nodes still means the same ones after rigging; what focal does not own stays as it was.
#include <cmath>
#include <functional>

#include "base/atomic_file.h"
#include "base/random.h"
#include "evaluation_data.h"
#include "gltf/small_skin.h"

using namespace focal;
using namespace focal_test;

namespace {

// A face below a turned node, with morph targets, whose joint carries a lamp.
GltfBuilder face() {
  GltfBuilder file = skinned_tetrahedron();
  const int offsets = file.add_accessor(std::vector<float>(12, 1), "VEC3");
  file.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", offsets}}};
  file.root["nodes"][0]["weights"] = {0};
  file.root["nodes"][0]["translation"] = {0, 0, 0};  // so that it may not carry a skin
  file.add_node({{"name", "lamp"},
                 {"translation", {0, 0, 2}},
                 {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
                1);
  const int times = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  const int shares = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  const auto pointing = [](const char* at) {
    return json{
        {"sampler", 0},
        {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", at}}}}}}}};
  };
  file.root["animations"] = json::array({{{"name", "smile"},
                                          {"samplers", {{{"input", times}, {"output", shares}}}},
                                          {"channels",
                                           {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}},
                                            pointing("/nodes/0/weights/0"),
                                            pointing("/nodes/0/weights"),
                                            pointing("/nodes/1/weights"),
                                            pointing("/materials/0/emissiveFactor")}}}});
  file.root["extensions"]["VRMC_vrm"] = {
      {"humanoid", {{"humanBones", {{"head", {{"node", 1}}}, {"hips", {{"node", 2}}}}}}},
      {"expressions",
       {{"preset", {{"happy", {{"morphTargetBinds", {{{"node", 0}, {"index", 0}, {"weight", 1}}}}}}}}}},
      {"firstPerson", {{"meshAnnotations", {{{"node", 0}, {"type", "both"}}}}}}};
  file.root["extensions"]["VRMC_springBone"] = {
      {"springs", {{{"joints", {{{"node", 1}}, {{"node", 2}}}}, {"center", 1}}}},
      {"colliders", {{{"node", 1}}}}};
  file.root["extensions"]["VRM"] = {
      {"humanoid", {{"humanBones", {{{"bone", "head"}, {"node", 1}}}}}},
      {"firstPerson", {{"firstPersonBone", 1}}},
      {"blendShapeMaster", {{"blendShapeGroups", {{{"binds", {{{"mesh", 0}}}}}}}}},
      {"secondaryAnimation",
       {{"boneGroups", {{{"bones", {1, 2}}, {"center", 1}}}}, {"colliderGroups", {{{"node", 1}}}}}}};
  file.root["nodes"][2]["extensions"]["VRMC_node_constraint"] = {
      {"constraint", {{"rotation", {{"source", 1}}}}}};
  return file;
}

json rigged(const GltfBuilder& file) {
  const auto source = file.glb();
  const GltfMesh mesh = read_gltf_memory(source);
  const auto own = read_gltf_rig(source, mesh.primitives);
  const Rig rig = two_joints(static_cast<size_t>(mesh.mesh.vertex_count()));
  GltfRig made{&rig, tips(), {}, {}, &mesh.mesh};
  made.replaces = {{}, {1, own->joints[0].bind}};
  return parsed(add_skin(source, mesh.primitives, made));
}

// Where a node stands in the world.
Matrix4 world_of(const json& root, size_t node) {
  const json& from = root["nodes"][node];
  NodePose pose;
  Matrix4 local = Matrix4::Identity();
  if (from.contains("translation"))
    for (int i = 0; i < 3; ++i)
      pose.translation[i] = from["translation"][static_cast<size_t>(i)].get<double>();
  if (from.contains("rotation"))
    for (int i = 0; i < 4; ++i)
      pose.rotation.coeffs()[i] = from["rotation"][static_cast<size_t>(i)].get<double>();
  local = matrix_of(pose);
  if (from.contains("matrix"))
    for (int i = 0; i < 16; ++i) local.data()[i] = from["matrix"][static_cast<size_t>(i)].get<double>();
  for (size_t above = 0; above < root["nodes"].size(); ++above)
    if (root["nodes"][above].contains("children"))
      for (const json& child : root["nodes"][above]["children"])
        if (child == node) return world_of(root, above) * local;
  return local;
}

}  // namespace

TEST_CASE("animations, expressions and annotations follow the mesh to its new node") {
  const GltfBuilder file = face();
  const json root = rigged(file);
  size_t carrier = 0;
  for (size_t n = 0; n < root["nodes"].size(); ++n)
    if (root["nodes"][n].contains("mesh")) carrier = n;
  REQUIRE(carrier != 0);
  CHECK(root["nodes"][carrier]["weights"] == json::array({0}));
  CHECK_FALSE(root["nodes"][0].contains("weights"));
  const json& channels = root["animations"][0]["channels"];
  CHECK(channels[0]["target"]["node"] == carrier);
  const auto pointer = [&](size_t channel) {
    return channels[channel]["target"]["extensions"]["KHR_animation_pointer"]["pointer"].get<std::string>();
  };
  const std::string weights = "/nodes/" + std::to_string(carrier) + "/weights";
  CHECK(pointer(1) == weights + "/0");
  CHECK(pointer(2) == weights);
  CHECK(pointer(3) == "/nodes/1/weights");
  CHECK(pointer(4) == "/materials/0/emissiveFactor");
  const json& vrm = root["extensions"]["VRMC_vrm"];
  CHECK(vrm["expressions"]["preset"]["happy"]["morphTargetBinds"][0]["node"] == carrier);
  CHECK(vrm["firstPerson"]["meshAnnotations"][0]["node"] == carrier);
}

TEST_CASE("humanoid bones, spring bones and constraints follow a joint to the one that stands for it") {
  const json root = rigged(face());
  const json& vrm = root["extensions"]["VRMC_vrm"];
  const auto head = vrm["humanoid"]["humanBones"]["head"]["node"].get<size_t>();
  CHECK(root["nodes"][head]["name"] == two_joints(1).joints[1].name);
  CHECK(vrm["humanoid"]["humanBones"]["hips"]["node"] == 2);  // nothing stands for it
  const json& springs = root["extensions"]["VRMC_springBone"];
  CHECK(springs["springs"][0]["joints"][0]["node"] == head);
  CHECK(springs["springs"][0]["joints"][1]["node"] == 2);
  CHECK(springs["springs"][0]["center"] == head);
  CHECK(springs["colliders"][0]["node"] == head);
  const json& old = root["extensions"]["VRM"];
  CHECK(old["humanoid"]["humanBones"][0]["node"] == head);
  CHECK(old["firstPerson"]["firstPersonBone"] == head);
  CHECK(old["blendShapeMaster"]["blendShapeGroups"][0]["binds"][0]["mesh"] == 0);
  CHECK(old["secondaryAnimation"]["boneGroups"][0]["bones"] == json({head, 2}));
  CHECK(old["secondaryAnimation"]["boneGroups"][0]["center"] == head);
  CHECK(old["secondaryAnimation"]["colliderGroups"][0]["node"] == head);
  CHECK(root["nodes"][2]["extensions"]["VRMC_node_constraint"]["constraint"]["rotation"]["source"] == head);
}

TEST_CASE("what hangs on a joint hangs on the one that stands for it, and stays where it is") {
  const GltfBuilder file = face();
  const json root = rigged(file);
  CHECK_FALSE(root["nodes"][1].contains("children"));
  CHECK((world_of(root, 2) - world_of(file.root, 2)).norm() < 1e-5);
  CHECK(root["nodes"][2]["translation"] == file.root["nodes"][2]["translation"]);
}

namespace {

// Whether all of `before` is in `after`, but for what focal owns. Lists may only have grown at their end.
class Kept {
 public:
  explicit Kept(bool is_posed) : is_posed_(is_posed) {}
  std::vector<std::string> lost;

  void compare(const json& before, const json& after, const std::string& path) {
    if (is_owned(path)) return;
    if (is_hierarchy(path)) {
      if (!is_subsequence(before, after)) lost.push_back(path);
    } else if (before.type() == after.type() && before.is_object()) {
      for (const auto& [key, value] : before.items()) {
        const std::string below = path + "/" + key;
        if (after.contains(key))
          compare(value, after[key], below);
        else if (!is_owned(below))
          lost.push_back(below);
      }
    } else if (before.is_array() && after.is_array() && after.size() >= before.size() && is_list(path)) {
      for (size_t i = 0; i < before.size(); ++i) compare(before[i], after[i], path + "/" + std::to_string(i));
    } else if (before != after) {
      lost.push_back(path);
    }
  }

 private:
  static std::string shape_of(const std::string& path) {  // numbers of elements do not count
    std::string shape;
    for (size_t i = 0; i < path.size(); ++i)
      if (!std::isdigit(static_cast<unsigned char>(path[i])) || path[i - 1] != '/')
        shape += path[i];
      else
        shape += '#', i = std::min(path.find('/', i), path.size()) - 1;
    return shape;
  }
  static bool is_list(const std::string& path) {
    const std::string shape = shape_of(path);
    return std::count(path.begin(), path.end(), '/') == 1 || shape == "/meshes/#/primitives" ||
           shape == "/animations/#/channels";
  }
  // Nodes are added; those that were there hang where they hung, in their order.
  static bool is_hierarchy(const std::string& path) {
    return shape_of(path) == "/nodes/#/children" || shape_of(path) == "/scenes/#/nodes";
  }
  static bool is_subsequence(const json& before, const json& after) {
    size_t found = 0;
    for (const json& one : after)
      if (found < before.size() && before[found] == one) ++found;
    return found == before.size();
  }
  bool is_owned(const std::string& path) const {
    const std::string shape = shape_of(path);
    // Where the joints place each vertex, positions are written as they are shown.
    if (is_posed_ && shape.starts_with("/meshes/#/primitives/#/")) return true;
    for (const char* owned :
         {"/nodes/#/mesh", "/nodes/#/skin", "/nodes/#/weights", "/skins/#/skeleton",
          "/meshes/#/primitives/#/indices", "/meshes/#/primitives/#/mode", "/buffers/#/byteLength"})
      if (shape == owned) return true;
    return shape.find("/attributes/JOINTS_") != std::string::npos ||
           shape.find("/attributes/WEIGHTS_") != std::string::npos ||
           shape == "/animations/#/channels/#/target/node";
  }

  bool is_posed_;
};

void check_kept(const std::vector<std::byte>& source, const std::vector<std::byte>& written, Kept kept) {
  kept.compare(parsed(source), parsed(written), "");
  std::string lost;
  for (const std::string& one : kept.lost) lost += one + " ";
  CHECK(lost == "");
  const auto before = open_container(source, {}), after = open_container(written, {});
  if (!before.has_bin || parsed(source)["buffers"][0].contains("uri")) return;
  const auto length = parsed(source)["buffers"][0]["byteLength"].get<size_t>();
  CHECK(std::equal(before.bin.begin(), before.bin.begin() + static_cast<std::ptrdiff_t>(length),
                   after.bin.begin()));
}

// After all that focal puts into a file: a skin and landmarks, and other weights where it has a skin.
void check_kept(const std::vector<std::byte>& source) {
  const GltfMesh mesh = read_gltf_memory(source);
  const Rig rig = two_joints(static_cast<size_t>(mesh.mesh.vertex_count()));
  const GltfLandmark mark{.name = "mark", .point = {0, Vector3(0.5, 0.25, 0.25)}};
  GltfDocument document(source);
  auto primitives = mesh.primitives;
  document.add_skin(primitives, {&rig, tips(), {}, {}, &mesh.mesh});
  document.add_landmarks(primitives, std::span(&mark, 1));
  const bool is_posed = std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                                    [](const GltfPrimitive& primitive) { return primitive.is_posed; });
  check_kept(source, document.bytes(), Kept(is_posed));
  if (const auto own = read_gltf_rig(source, mesh.primitives)) {
    GltfDocument weighted(source);
    weighted.replace_weights(mesh.primitives, *own);
    check_kept(source, weighted.bytes(), Kept(is_posed));
  }
}

json anything(Random& random, int depth) {
  switch (random.below(depth > 0 ? 8 : 6)) {
    case 0:
      return nullptr;
    case 1:
      return random.below(2) == 0;
    case 2:
      return static_cast<int64_t>(random.below(1000)) - 500;
    case 3:
      return 18446744073709551615u;
    case 4:
      return std::ldexp(static_cast<double>(random.below(1u << 30)), -17);
    case 5:
      return "tëxt \"" + std::to_string(random.below(100));
    case 6: {
      json list = json::array();
      for (uint32_t i = random.below(4); i > 0; --i) list.push_back(anything(random, depth - 1));
      return list;
    }
    default: {
      json object = json::object();
      for (uint32_t i = random.below(4); i > 0; --i)
        object["k" + std::to_string(i)] = anything(random, depth - 1);
      return object;
    }
  }
}

}  // namespace

TEST_CASE("every member that focal does not own is there again: generated documents") {
  Random random(11);
  for (int round = 0; round < 200; ++round) {
    GltfBuilder file = round % 3 == 0 ? rich_file() : round % 3 == 1 ? skinned_tetrahedron() : tetrahedron();
    if (round % 3 == 0) file.root.erase("buffers");
    if (round % 5 == 0) file.add_node({{"mesh", 0}, {"scale", {-1, 1, 1}}});
    for (uint32_t extras = random.below(12); extras > 0; --extras) {
      std::function<void(json&)> put = [&](json& into) {
        const uint32_t deeper = random.below(3);
        if (deeper > 0 && into.is_object() && !into.empty()) {
          auto at = into.begin();
          std::advance(at, random.below(static_cast<uint32_t>(into.size())));
          if (at->is_structured() && !at->empty())
            return put(at->is_array() ? (*at)[random.below(static_cast<uint32_t>(at->size()))] : *at);
        }
        if (into.is_object() && !into.contains("POSITION"))
          into["extras"]["x" + std::to_string(extras)] = anything(random, 3);
      };
      put(file.root);
    }
    CAPTURE(round);
    check_kept(file.glb());
  }
}

TEST_CASE("every member that focal does not own is there again: real files") {
  const char* data = std::getenv("FOCAL_EVALUATION_DATA");
  if (!data || !std::filesystem::exists(data)) return;
  const std::filesystem::path root = data;
  int files = 0, refused = 0;
  for (const auto& folder : {root / "rigs", root / "wild" / "dev", root / "corpora" / "gltf_valid",
                             root.parent_path() / "cases"}) {
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".glb" && entry.path().extension() != ".gltf") continue;
      CAPTURE(entry.path());
      const auto source = read_file(entry.path());
      if (!error_of(source).empty()) {  // holds no triangles, buffers beside it, no glTF
        ++refused;
        continue;
      }
      check_kept(source);
      ++files;
    }
  }
  std::cout << files << " files written and compared, " << refused << " refused before\n";
}
