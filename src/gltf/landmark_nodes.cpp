// Landmarks put into the caller's own glTF document.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "base/error.h"
#include "gltf/document_edit.h"
#include "gltf/glb.h"
#include "gltf/writer.h"

namespace focal {
namespace {

using Json = OrderedJson;

constexpr const char* kGroupName = "focal_landmarks";
constexpr const char* kVersion = "1";

std::string describe(const GltfLandmark& landmark) {
  return R"("status":)" + json_string(landmark.status) + R"(,"confidence":)" +
         json_number(landmark.confidence);
}

void check(const GltfLandmark& landmark) {
  const bool finite = landmark.position.cast<float>().allFinite() && landmark.point.barycentric.allFinite() &&
                      std::isfinite(landmark.confidence);
  if (!finite)
    throw Error(Status::invalid_landmark, "landmark " + json_string(landmark.name) + " is not finite",
                "leave it out or give it the status absent");
}

class LandmarkInserter {
 public:
  LandmarkInserter(Json& root, std::span<const GltfPrimitive> primitives)
      : root_(root), primitives_(primitives), pool_(root) {}

  void add_nodes(std::span<const GltfLandmark> landmarks);
  void add_mesh_extras(std::span<const GltfLandmark> landmarks);

 private:
  void release_former_nodes(Json& scene_nodes);
  const GltfPrimitive& primitive_of(const GltfLandmark& landmark) const;

  Json& root_;
  std::span<const GltfPrimitive> primitives_;
  NodePool pool_;
};

// The group of an earlier call leaves the scene, and its nodes may be used again. One to which the user has hung something of
// his own stays.
void LandmarkInserter::release_former_nodes(Json& scene_nodes) {
  Json& nodes = root_["nodes"];
  const auto is_bare = [&](const Json& index) {
    Json& node = nodes[index.get<size_t>()];
    return focal_extras(node) && !find(node, "mesh") && !find(node, "camera") && !find(node, "skin");
  };
  const auto is_leaf = [&](const Json& index) {
    return is_bare(index) && !find(nodes[index.get<size_t>()], "children");
  };
  const auto is_former_group = [&](const Json& index) {
    const Json* children = find(nodes[index.get<size_t>()], "children");
    return is_bare(index) && (!children || std::all_of(children->begin(), children->end(), is_leaf));
  };
  auto& roots = scene_nodes.get_ref<Json::array_t&>();
  const auto former = std::stable_partition(roots.begin(), roots.end(), std::not_fn(is_former_group));
  std::vector<size_t> released;
  for (auto group = former; group != roots.end(); ++group) {
    released.push_back(group->get<size_t>());
    if (const Json* children = find(nodes[group->get<size_t>()], "children"))
      for (const Json& child : *children) released.push_back(child.get<size_t>());
  }
  roots.erase(former, roots.end());
  pool_.release(released);
}

void LandmarkInserter::add_nodes(std::span<const GltfLandmark> landmarks) {
  Json& scene_nodes = member_or_new(shown_scene(root_), "nodes", Json::value_t::array);
  release_former_nodes(scene_nodes);
  Json& nodes = root_["nodes"];
  const size_t group = pool_.take();
  std::string children;
  for (const GltfLandmark& landmark : landmarks) {
    if (landmark.status == "absent") continue;
    const size_t node = pool_.take();
    put(nodes[node], R"({"name":)" + json_string(landmark.name) + R"(,"translation":)" +
                         json_array(landmark.position) + R"(,"extras":{"focal":{)" + describe(landmark) +
                         "}}}");
    children += (children.empty() ? "" : ",") + std::to_string(node);
  }
  put(nodes[group], std::string(R"({"name":")") + kGroupName + R"(",)" +
                        (children.empty() ? "" : R"("children":[)" + children + "],") +
                        R"("extras":{"focal":{"version":)" + kVersion + "}}}");
  scene_nodes.push_back(group);
}

const GltfPrimitive& LandmarkInserter::primitive_of(const GltfLandmark& landmark) const {
  const auto holds = [&](const GltfPrimitive& primitive) {
    const int32_t local = landmark.point.triangle - primitive.first_triangle;
    return local >= 0 && local < primitive.triangle_count;
  };
  const auto found = std::find_if(primitives_.begin(), primitives_.end(), holds);
  if (found == primitives_.end())
    throw Error(Status::invalid_landmark,
                "landmark " + json_string(landmark.name) + " lies on triangle " +
                    std::to_string(landmark.point.triangle) + ", which the file does not have",
                "pass the primitives read from this file");
  return *found;
}

void LandmarkInserter::add_mesh_extras(std::span<const GltfLandmark> landmarks) {
  std::map<int32_t, std::string> entries;  // per mesh
  for (const GltfLandmark& landmark : landmarks) {
    const bool placed = landmark.point.triangle >= 0;
    if (!placed && primitives_.empty()) continue;
    const GltfPrimitive& primitive = placed ? primitive_of(landmark) : primitives_.front();
    std::string& text = entries[primitive.mesh];
    text +=
        (text.empty() ? "" : ",") + (R"({"name":)" + json_string(landmark.name)) + "," + describe(landmark);
    if (placed) {
      Vector3 weights = landmark.point.barycentric;
      if (primitive.mirrored) std::swap(weights(1), weights(2));
      text += R"(,"primitive":)" + std::to_string(primitive.primitive) + R"(,"triangle":)" +
              std::to_string(landmark.point.triangle - primitive.first_triangle) + R"(,"barycentric":)" +
              json_array(weights);
    }
    text += "}";
  }
  Json* meshes = find(root_, "meshes");
  for (size_t mesh = 0; meshes && mesh < meshes->size(); ++mesh) {
    Json& element = (*meshes)[mesh];
    const auto entry = entries.find(static_cast<int32_t>(mesh));
    if (entry == entries.end() && !focal_extras(element)) continue;
    Json& extras = member_or_new(element, "extras", Json::value_t::object);
    if (!extras.is_object())
      continue;  // extras may be anything; another's number or text is not ours to replace
    put(extras["focal"], std::string(R"({"version":)") + kVersion + R"(,"landmarks":[)" +
                             (entry == entries.end() ? "" : entry->second) + "]}");
  }
}

}  // namespace

std::vector<std::byte> add_landmarks(std::span<const std::byte> source,
                                     std::span<const GltfPrimitive> primitives,
                                     std::span<const GltfLandmark> landmarks, const GltfLimits& limits) {
  for (const GltfLandmark& landmark : landmarks) check(landmark);
  const GltfContainer container = open_container(source, limits);
  parse_gltf(container, limits);  // every reference followed below is checked here
  OrderedJsonDocument document(container.json, {.depth = limits.json_depth, .values = limits.json_values});
  LandmarkInserter inserter(document.root(), primitives);
  inserter.add_nodes(landmarks);
  inserter.add_mesh_extras(landmarks);
  return edited_file(container, document.root());
}

}  // namespace focal
