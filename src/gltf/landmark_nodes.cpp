// Adds landmarks to the caller's own glTF document.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "base/error.h"
#include "gltf/document_edit.h"
#include "gltf/opened.h"
#include "gltf/text.h"

namespace focal {
namespace {

using Json = OrderedJson;

constexpr const char* group_name = "focal_landmarks";
constexpr int format_version = 1;

void describe(const GltfLandmark& landmark, Json& to) {
  at(to, "status") = name_of(landmark.status);
  at(to, "confidence") = short_number(landmark.confidence);
}

void check(const GltfLandmark& landmark) {
  const bool finite = landmark.position.cast<float>().allFinite() && landmark.point.barycentric.allFinite() &&
                      std::isfinite(landmark.confidence);
  if (!finite)
    throw Error(Status::invalid_landmark, "landmark '" + printable(landmark.name) + "' is not finite",
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
  void describe_place(const GltfLandmark& landmark, const GltfPrimitive& primitive, Json& to) const;

  Json& root_;
  std::span<const GltfPrimitive> primitives_;
  NodePool pool_;
};

// Removes the group of an earlier call from the scene and releases its nodes. A group to which the user has
// attached other nodes is kept.
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
  std::vector<size_t> children;
  for (const GltfLandmark& landmark : landmarks) {
    if (landmark.status == LandmarkStatus::absent) continue;
    children.push_back(pool_.take());
    Json& node = nodes[children.back()];
    at(node, "name") = landmark.name;
    put_vector(node, "translation", landmark.position);
    describe(landmark, new_object(new_object(at(node, "extras"))["focal"]));
  }
  Json& node = nodes[group];
  at(node, "name") = group_name;
  if (!children.empty())
    for (Json& list = new_list(at(node, "children")); const size_t child : children) list.push_back(child);
  new_object(new_object(at(node, "extras"))["focal"])["version"] = format_version;
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
                "landmark '" + printable(landmark.name) + "' is on triangle " +
                    std::to_string(landmark.point.triangle) + ", which the file does not have",
                "pass the primitives read from this file");
  return *found;
}

void LandmarkInserter::describe_place(const GltfLandmark& landmark, const GltfPrimitive& primitive,
                                      Json& to) const {
  Vector3 weights = landmark.point.barycentric;
  if (primitive.mirrored) std::swap(weights(1), weights(2));
  const auto is_other = [&](const GltfPrimitive& one) {
    return one.mesh == primitive.mesh && one.node != primitive.node;
  };
  at(to, "primitive") = primitive.primitive;
  at(to, "triangle") = landmark.point.triangle - primitive.first_triangle;
  put_vector(to, "barycentric", weights);
  // If several nodes show the mesh, the primitive's own node.
  if (std::any_of(primitives_.begin(), primitives_.end(), is_other)) at(to, "node") = primitive.node;
}

void LandmarkInserter::add_mesh_extras(std::span<const GltfLandmark> landmarks) {
  std::map<int32_t, std::vector<const GltfLandmark*>> entries;  // per mesh
  for (const GltfLandmark& landmark : landmarks) {
    const bool placed = landmark.point.triangle >= 0;
    if (!placed && primitives_.empty()) continue;
    entries[(placed ? primitive_of(landmark) : primitives_.front()).mesh].push_back(&landmark);
  }
  Json* meshes = find(root_, "meshes");
  for (size_t mesh = 0; meshes && mesh < meshes->size(); ++mesh) {
    Json& element = (*meshes)[mesh];
    const auto entry = entries.find(static_cast<int32_t>(mesh));
    if (entry == entries.end() && !focal_extras(element)) continue;
    Json& extras = member_or_new(element, "extras", Json::value_t::object);
    // Extras can be anything; a number or text of another program is not ours to replace.
    if (!extras.is_object()) continue;
    Json& own = new_object(at(extras, "focal"));
    own["version"] = format_version;
    Json& list = new_list(own["landmarks"]);
    for (const GltfLandmark* landmark :
         entry == entries.end() ? std::vector<const GltfLandmark*>() : entry->second) {
      list.emplace_back(nullptr);
      Json& to = new_object(list.back());
      at(to, "name") = landmark->name;
      describe(*landmark, to);
      if (landmark->point.triangle >= 0) describe_place(*landmark, primitive_of(*landmark), to);
    }
  }
}

}  // namespace

void GltfDocument::add_landmarks(std::span<const GltfPrimitive> primitives,
                                 std::span<const GltfLandmark> landmarks) {
  for (const GltfLandmark& landmark : landmarks) check(landmark);
  LandmarkInserter inserter(edited().document.root(), primitives);
  inserter.add_nodes(landmarks);
  inserter.add_mesh_extras(landmarks);
}

}  // namespace focal
