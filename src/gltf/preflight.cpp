// Checks every count, index, offset and extent of a glTF document once, in 64-bit arithmetic.
#include "gltf/preflight.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <vector>

#include "base/error.h"
#include "gltf/element.h"
#include "gltf/fields.h"
#include "gltf/text.h"

namespace focal {
namespace {

using nlohmann::json;

int64_t count_of(const json& root, const char* key) { return static_cast<int64_t>(list(root, key).size()); }

// Calls check(element, place) for each element of a top-level list.
template <class Check>
void for_each(const json& root, const char* key, Check&& check) {
  const json& elements = list(root, key);
  for (size_t i = 0; i < elements.size(); ++i) check(elements[i], Place{key, static_cast<int64_t>(i)});
}

void check_number(int64_t number, const char* what, const GltfLimits& limits) {
  if (number > limits.nodes)
    throw Error(Status::unsupported, "glTF with " + std::to_string(number) + " " + what,
                "split the file or raise the limit");
}

void check_lists(const json& root, const GltfLimits& limits) {
  for (const char* key : {"accessors", "buffers", "bufferViews", "meshes", "nodes", "scenes", "skins"}) {
    const json* elements = member(root, key);
    if (!elements) continue;
    if (!elements->is_array()) fail_field({"document"}, key, "is not an array");
    check_number(static_cast<int64_t>(elements->size()), key, limits);
    for_each(root, key, [](const json& element, const Place& place) {
      if (!element.is_object()) fail_field(place, "", "is not an object");
    });
  }
}

// "2.1" is {2, 1}; {-1, -1} when malformed.
std::array<int, 2> version_of(const std::string& text) {
  std::array<int, 2> version{-1, -1};
  const char* const end = text.data() + text.size();
  const auto major = std::from_chars(text.data(), end, version[0]);
  if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.') return {-1, -1};
  const auto minor = std::from_chars(major.ptr + 1, end, version[1]);
  return minor.ec == std::errc() && minor.ptr == end ? version : std::array{-1, -1};
}

void check_asset(const json& root) {
  const Place place{"asset"};
  const json* asset = object(root, "asset", {"document"});
  if (!asset) fail_field({"document"}, "asset", "is missing");
  const std::string* version = text(*asset, "version", place);
  if (!version || version_of(*version)[0] < 0) fail_field(place, "version", "is missing or malformed");
  const std::string* least = text(*asset, "minVersion", place);
  if (version_of(*version)[0] != 2 || (least && version_of(*least) > std::array{2, 0}))
    throw Error(Status::unsupported, "glTF version " + printable(least ? *least : *version),
                "convert the file to glTF 2.0");
}

// Extensions that do not affect the position of the surface, and the two that are decoded.
bool is_understood(const std::string& name) {
  constexpr std::array prefixes{"KHR_materials_", "KHR_texture_", "EXT_texture_",  "MSFT_texture_",
                                "KHR_lights_",    "EXT_lights_",  "KHR_animation_"};
  constexpr std::array known_extensions{"KHR_mesh_quantization", "EXT_meshopt_compression",
                                        "KHR_node_visibility", "KHR_xmp_json_ld"};
  return std::any_of(prefixes.begin(), prefixes.end(), [&](const char* p) { return name.starts_with(p); }) ||
         std::find(known_extensions.begin(), known_extensions.end(), name) != known_extensions.end();
}

void check_extensions(const json& root) {
  const json* required = array(root, "extensionsRequired", {"document"});
  if (!required) return;
  for (const json& entry : *required) {
    if (!entry.is_string())
      fail_field({"document"}, "extensionsRequired", "contains something other than names");
    const auto& name = entry.get_ref<const std::string&>();
    if (is_understood(name)) continue;
    const bool draco = name == "KHR_draco_mesh_compression";
    throw Error(
        Status::unsupported, "the file requires the extension " + printable(name),
        draco ? "decompress it first, for example with `gltf-transform copy in.glb out.glb`, or export it "
                "with compression off"
              : "export the file without this extension");
  }
}

void check_buffer(const json& buffer, const Place& place) {
  integer(buffer, "byteLength", place, 1, max_file_bytes);
  text(buffer, "uri", place);
}

// An extent inside the declared length of a buffer.
void check_extent(const json& root, const json& owner, const Place& place) {
  const int64_t buffer = reference(owner, "buffer", place, count_of(root, "buffers"), true);
  const int64_t offset = integer(owner, "byteOffset", place, 0, max_file_bytes, 0);
  const int64_t length = integer(owner, "byteLength", place, 1, max_file_bytes);
  const int64_t available = checked_integer(list(root, "buffers")[buffer], "byteLength");
  if (offset + length > available) fail_field(place, "byteLength", "reaches beyond its buffer");
}

void check_view(const json& root, const json& view, const Place& place) {
  check_extent(root, view, place);
  if (member(view, "byteStride")) integer(view, "byteStride", place, 4, 252);
  const json* compressed = extension(view, "EXT_meshopt_compression");
  if (!compressed) return;
  check_extent(root, *compressed, place);
  for (const char* key : {"byteOffset", "byteLength"}) integer(*compressed, key, place, 0, INT32_MAX, 0);
  const int64_t stride = integer(*compressed, "byteStride", place, 1, 256);
  const int64_t count = integer(*compressed, "count", place, 1, INT32_MAX);
  if (stride * count != checked_integer(view, "byteLength"))
    fail_field(place, "extensions", "EXT_meshopt_compression decodes to another length than the view has");
  text(*compressed, "mode", place);
  text(*compressed, "filter", place);
}

// Checks that `count` entries fit into the view that `owner` refers to.
void check_entries(const json& root, const json& owner, const Place& place, const Element& element,
                   int64_t count, bool may_be_strided) {
  const int64_t index = reference(owner, "bufferView", place, count_of(root, "bufferViews"), true);
  const json& view = list(root, "bufferViews")[index];
  const int64_t offset = integer(owner, "byteOffset", place, 0, max_file_bytes, 0);
  const int64_t size = element.size();
  const int64_t stride = may_be_strided ? checked_integer(view, "byteStride", size) : size;
  if (stride < size) fail_field(place, "bufferView", "has a stride smaller than an element");
  if (offset + element.extent(count, stride) > checked_integer(view, "byteLength"))
    fail_field(place, "count", "is " + std::to_string(count) + ", reaching beyond its buffer view");
}

void check_sparse(const json& root, const json& sparse, const Place& place, const Element& element) {
  const int64_t count = integer(sparse, "count", place, 1, element.count);
  for (const char* end : {"indices", "values"})
    if (const json* part = object(sparse, end, place)) integer(*part, "byteOffset", place, 0, INT32_MAX, 0);
  const json* indices = object(sparse, "indices", place);
  const json* values = object(sparse, "values", place);
  if (!indices || !values) fail_field(place, "sparse", "lacks indices or values");
  Element index;
  index.type = static_cast<ComponentType>(integer(*indices, "componentType", place, 5121, 5125));
  if (!is_index_type(index.type)) fail_field(place, "sparse", "has indices of an unsupported type");
  check_entries(root, *indices, place, index, count, false);
  check_entries(root, *values, place, element, count, false);
}

void check_accessor(const json& root, const json& accessor, const Place& place, bool lenient) {
  const Element element = element_of(accessor, place);
  if (element.count == 0 && !lenient)
    fail_field(place, "count", "is 0: the accessor is empty; --lenient (lenient) leaves such parts out");
  if (member(accessor, "bufferView"))
    check_entries(root, accessor, place, element, element.count, true);
  else if (member(accessor, "byteOffset"))
    fail_field(place, "byteOffset", "is given without a bufferView");
  if (const json* sparse = object(accessor, "sparse", place)) check_sparse(root, *sparse, place, element);
}

constexpr int64_t unknown = -1;

// All attributes of a primitive or morph target must refer to accessors with one entry per vertex. Returns
// that number.
int64_t check_attributes(const json& root, const json& attributes, const Place& place, int64_t vertices) {
  for (const auto& [name, value] : attributes.items()) {
    const int64_t index = as_reference(value, name.c_str(), place, count_of(root, "accessors"));
    const Element element = element_of(list(root, "accessors")[index], place);
    if (vertices != unknown && element.count != vertices)
      fail_field(place, name.c_str(), "has another number of entries than the other attributes");
    if (name == "POSITION" && (element.components != 3 || element.type == ComponentType::u32))
      fail_field(place, "POSITION", "is not a VEC3 of a type that positions may have");
    vertices = element.count;
  }
  return vertices;
}

void check_primitive(const json& root, const json& primitive, const Place& place) {
  const json* attributes = object(primitive, "attributes", place);
  if (!attributes) fail_field(place, "attributes", "is missing");
  const int64_t vertices = check_attributes(root, *attributes, place, unknown);
  if (member(primitive, "mode")) integer(primitive, "mode", place, 0, 6);
  const int64_t indices = reference(primitive, "indices", place, count_of(root, "accessors"));
  if (indices >= 0) {
    const Element element = element_of(list(root, "accessors")[indices], place);
    if (element.components != 1 || !is_index_type(element.type) || element.normalized)
      fail_field(place, "indices", "is not a scalar of unsigned integers");
  }
  const json* targets = array(primitive, "targets", place);
  if (!targets) return;
  for (const json& target : *targets) {
    if (!target.is_object()) fail_field(place, "targets", "contains something other than objects");
    check_attributes(root, target, place, vertices);
  }
}

void check_weights(const json& owner, const Place& place) {
  const json* weights = array(owner, "weights", place);
  if (weights && !std::all_of(weights->begin(), weights->end(), [](const json& w) { return w.is_number(); }))
    fail_field(place, "weights", "contains something other than numbers");
}

void check_mesh(const json& root, const json& mesh, const Place& place, const GltfLimits& limits,
                bool lenient) {
  check_weights(mesh, place);
  const json* primitives = array(mesh, "primitives", place);
  if (!primitives && lenient) return;
  if (!primitives || (primitives->empty() && !lenient))
    fail_field(place, "primitives", "is missing or empty; --lenient (lenient) leaves such a mesh out");
  check_number(static_cast<int64_t>(primitives->size()), "primitives of a mesh", limits);
  for (const json& primitive : *primitives) {
    if (!primitive.is_object()) fail_field(place, "primitives", "contains something other than objects");
    check_primitive(root, primitive, place);
  }
}

void check_references(const json& root, const json& owner, const char* key, const Place& place) {
  const json* values = array(owner, key, place);
  if (!values) return;
  for (const json& value : *values) as_reference(value, key, place, count_of(root, "nodes"));
}

void check_visibility(const json& node, const Place& place) {
  const json* visibility = extension(node, "KHR_node_visibility");
  const json* visible = visibility ? member(*visibility, "visible") : nullptr;
  if (visible && !visible->is_boolean())
    fail_field(place, "extensions", "KHR_node_visibility has a visible that is not a boolean");
}

void check_node(const json& root, const json& node, const Place& place) {
  check_weights(node, place);
  check_visibility(node, place);
  reference(node, "mesh", place, count_of(root, "meshes"));
  reference(node, "skin", place, count_of(root, "skins"));
  check_references(root, node, "children", place);
  constexpr std::array<std::pair<const char*, size_t>, 4> sizes{
      {{"matrix", 16}, {"translation", 3}, {"rotation", 4}, {"scale", 3}}};
  for (const auto& [key, size] : sizes) {
    const json* values = array(node, key, place);
    if (!values) continue;
    const auto is_number = [](const json& value) { return value.is_number(); };
    if (values->size() != size || !std::all_of(values->begin(), values->end(), is_number))
      fail_field(place, key, "is not " + std::to_string(size) + " numbers");
  }
}

// Returns the number of inverse bind matrices.
int64_t check_skin(const json& root, const json& skin, const Place& place) {
  const json* joints = array(skin, "joints", place);
  if (!joints || joints->empty()) fail_field(place, "joints", "is missing or empty");
  if (static_cast<int64_t>(joints->size()) > count_of(root, "nodes"))
    fail_field(place, "joints", "names a node twice");
  check_references(root, skin, "joints", place);
  const int64_t matrices = reference(skin, "inverseBindMatrices", place, count_of(root, "accessors"));
  if (matrices < 0) return 0;
  const Element element = element_of(list(root, "accessors")[matrices], place);
  if (element.components != 16 || element.type != ComponentType::f32)
    fail_field(place, "inverseBindMatrices", "is not a MAT4 of floats");
  if (element.count < static_cast<int64_t>(joints->size()))
    fail_field(place, "inverseBindMatrices", "has fewer matrices than there are joints");
  return element.count;
}

// The total is limited too: a thousand skins may refer to the same large accessor.
void check_skins(const json& root, const GltfLimits& limits) {
  int64_t matrices = 0;
  for_each(root, "skins", [&](const json& skin, const Place& place) {
    matrices += check_skin(root, skin, place);
    check_number(matrices, "skin matrices", limits);
  });
}

// At most one parent each, and everything reachable from a root: then there is no cycle.
void check_forest(const json& root) {
  const json& nodes = list(root, "nodes");
  std::vector<bool> has_parent(nodes.size());
  for_each(root, "nodes", [&](const json& node, const Place& place) {
    for (const json& child : list(node, "children")) {
      const auto index = child.get<size_t>();
      if (has_parent[index]) fail_field(place, "children", "names a node that has a parent already");
      has_parent[index] = true;
    }
  });
  std::vector<size_t> open;
  for (size_t i = 0; i < nodes.size(); ++i)
    if (!has_parent[i]) open.push_back(i);
  size_t reached = 0;
  for (; !open.empty(); ++reached) {
    const json& children = list(nodes[open.back()], "children");
    open.pop_back();
    for (const json& child : children) open.push_back(child.get<size_t>());
  }
  if (reached != nodes.size()) fail_field({"nodes"}, "children", "form a cycle");
}

}  // namespace

JsonDocument parse_gltf(const GltfContainer& container, const GltfLimits& limits, bool lenient) {
  JsonDocument document(container.json, {.depth = limits.json_depth, .values = limits.json_values});
  const json& root = document.root();
  if (!root.is_object()) throw Error(Status::invalid_file, "JSON, but not glTF", "pass a .glb or .gltf file");
  check_asset(root);
  check_extensions(root);
  check_lists(root, limits);
  for_each(root, "buffers", check_buffer);
  for_each(root, "bufferViews", [&](const json& e, const Place& place) { check_view(root, e, place); });
  for_each(root, "accessors",
           [&](const json& e, const Place& place) { check_accessor(root, e, place, lenient); });
  for_each(root, "meshes",
           [&](const json& e, const Place& place) { check_mesh(root, e, place, limits, lenient); });
  check_skins(root, limits);
  for_each(root, "nodes", [&](const json& e, const Place& place) { check_node(root, e, place); });
  for_each(root, "scenes",
           [&](const json& e, const Place& place) { check_references(root, e, "nodes", place); });
  reference(root, "scene", {"document"}, count_of(root, "scenes"));
  check_forest(root);
  return document;
}

}  // namespace focal
