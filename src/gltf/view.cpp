// See view.h.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <initializer_list>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

// The JSON tree that tinygltf builds for itself. nlohmann's destructor allocates, in noexcept, to flatten
// what it frees; without memory the process would terminate. So the tree has a type of its own, whose lists
// use a reserve when an allocation fails.
namespace focal_view_json {
using json = nlohmann::basic_json<std::map, std::vector, std::string, bool, int64_t, uint64_t, double,
                                  std::allocator, nlohmann::adl_serializer, std::vector<signed char>>;

struct Reserve {
  std::byte *free = nullptr, *begin = nullptr, *end = nullptr;
};
thread_local Reserve reserve;

void* allocate(size_t size) {
  if (void* block = ::operator new(size, std::nothrow)) return block;
  if (static_cast<size_t>(reserve.end - reserve.free) < size) throw std::bad_alloc();
  return std::exchange(reserve.free, reserve.free + size);
}

void deallocate(void* block) {
  const auto* at = static_cast<std::byte*>(block);
  if (at < reserve.begin || at >= reserve.end) ::operator delete(block);
}

}  // namespace focal_view_json

template <>
class std::allocator<focal_view_json::json> {
 public:
  using value_type = focal_view_json::json;
  using size_type = size_t;
  using difference_type = ptrdiff_t;
  using propagate_on_container_move_assignment = true_type;
  using is_always_equal = true_type;
  allocator() = default;
  template <class Other>
  allocator(const allocator<Other>&) noexcept {}
  value_type* allocate(size_t count) {
    return static_cast<value_type*>(focal_view_json::allocate(count * sizeof(value_type)));
  }
  void deallocate(value_type* block, size_t) { focal_view_json::deallocate(block); }
  friend bool operator==(const allocator&, const allocator&) { return true; }
};

#define nlohmann focal_view_json
#define TINYGLTF_IMPLEMENTATION
#include "gltf/view.h"
#undef nlohmann

#include "base/error.h"
#include "gltf/fields.h"
#include "gltf/text.h"

namespace focal {
namespace {

using nlohmann::json;
using Names = std::initializer_list<const char*>;

// Writes the parts of a document that the view keeps.
class Filter {
 public:
  explicit Filter(const json& root) : root_(root) {}

  std::string run();
  std::vector<std::string> broken_animations;
  std::vector<size_t> pointer_channels;

 private:
  void put(const json& value);
  void put_members(const json& object, Names names);
  template <class Put>
  void put_list(const json& list, Put&& put_element);
  void key(const char* name);
  void put_view(const json& view);
  void put_accessor(const json& accessor);
  void put_primitive(const json& primitive);
  void put_mesh(const json& mesh);
  void put_node(const json& node);
  void put_animation(const json& animation);
  std::string what_is_broken(const json& animation) const;

  const json& root_;
  std::string text_;
};

// A whole number stays one in any notation: tinygltf does not accept 1.0 as an index.
void Filter::put(const json& value) {
  constexpr double exact = 9007199254740992.0;  // 2^53
  if (value.is_number_float()) {
    const double number = value.get<double>();
    text_ += std::abs(number) < exact && number == std::floor(number)
                 ? std::to_string(static_cast<int64_t>(number))
                 : value.dump();
  } else if (value.is_array()) {
    put_list(value, [&](const json& element) { put(element); });
  } else if (value.is_object()) {
    const char* comma = "{";
    for (const auto& [name, member] : value.items())
      text_ += comma + json(name).dump() + ":", put(member), comma = ",";
    text_ += value.empty() ? "{}" : "}";
  } else {
    text_ += value.dump();
  }
}

void Filter::key(const char* name) {
  if (text_.back() != '{') text_ += ',';
  text_ += '"', text_ += name, text_ += "\":";
}

void Filter::put_members(const json& object, Names names) {
  for (const char* name : names)
    if (const json* value = member(object, name)) key(name), put(*value);
}

template <class Put>
void Filter::put_list(const json& list, Put&& put_element) {
  text_ += '[';
  for (const json& element : list) {
    if (text_.back() != '[') text_ += ',';
    put_element(element);
  }
  text_ += ']';
}

// tinygltf refuses a stride that is not a multiple of 4: it is passed as an extension.
void Filter::put_view(const json& view) {
  text_ += '{';
  const bool is_odd = checked_integer(view, "byteStride") % 4 != 0;
  put_members(view, {"buffer", "byteOffset", "byteLength"});
  if (!is_odd) put_members(view, {"byteStride"});
  const json* compressed = extension(view, "EXT_meshopt_compression");
  if (compressed || is_odd) {
    key("extensions"), text_ += '{';
    if (compressed) key("EXT_meshopt_compression"), put(*compressed);
    if (is_odd) key("focal_stride"), put(view["byteStride"]);
    text_ += '}';
  }
  text_ += '}';
}

void Filter::put_accessor(const json& accessor) {
  text_ += '{';
  put_members(accessor,
              {"bufferView", "byteOffset", "componentType", "normalized", "count", "type", "sparse"});
  if (!member(accessor, "bufferView"))
    key("bufferView"), text_ += std::to_string(list(root_, "bufferViews").size());
  text_ += '}';
}

void Filter::put_primitive(const json& primitive) {
  text_ += '{';
  put_members(primitive, {"attributes", "indices", "mode", "targets"});
  if (extension(primitive, "KHR_draco_mesh_compression"))
    key("extensions"), text_ += R"({"KHR_draco_mesh_compression":{}})";
  text_ += '}';
}

void Filter::put_mesh(const json& mesh) {
  text_ += '{';
  put_members(mesh, {"weights"});
  key("primitives"), put_list(list(mesh, "primitives"), [&](const json& one) { put_primitive(one); });
  text_ += '}';
}

void Filter::put_node(const json& node) {
  text_ += '{';
  const json* name = member(node, "name");
  if (name && name->is_string()) key("name"), put(*name);
  put_members(node, {"mesh", "skin", "children", "matrix", "translation", "rotation", "scale", "weights"});
  if (const json* visibility = extension(node, "KHR_node_visibility"))
    key("extensions"), text_ += R"({"KHR_node_visibility":)", put(*visibility), text_ += '}';
  text_ += '}';
}

bool names_one_of(const json& owner, const char* key, const json& list) {
  const json* index = member(owner, key);
  return index && index->is_number_unsigned() && index->get<uint64_t>() < list.size();
}

// Whether it moves a node; else an extension defines the target.
bool moves_node(const json& target) {
  const json* path = member(target, "path");
  return member(target, "node") && path && path->is_string();
}

// parse_gltf does not check animations, since many files with a bad one are usable otherwise.
std::string Filter::what_is_broken(const json& animation) const {
  if (!animation.is_object()) return "is not an object";
  const json &channels = list(animation, "channels"), &samplers = list(animation, "samplers");
  if (!channels.is_array() || !samplers.is_array()) return "has channels or samplers that are not an array";
  for (const json& sampler : samplers)
    for (const char* end : {"input", "output"})
      if (!sampler.is_object() || !names_one_of(sampler, end, list(root_, "accessors")))
        return std::string("has an invalid sampler ") + end;
  for (const json& channel : channels) {
    const json* target = channel.is_object() ? member(channel, "target") : nullptr;
    if (!target || !target->is_object()) return "has a channel without a target";
    if (!moves_node(*target)) continue;
    if (!names_one_of(*target, "node", list(root_, "nodes"))) return "refers to an invalid node";
    if (!names_one_of(channel, "sampler", samplers)) return "refers to an invalid sampler";
  }
  return "";
}

void Filter::put_animation(const json& animation) {
  broken_animations.push_back(what_is_broken(animation));
  pointer_channels.push_back(0);
  text_ += '{';
  if (broken_animations.back().empty()) {
    const json* name = member(animation, "name");
    if (name && name->is_string()) key("name"), put(*name);
    key("samplers"), put_list(list(animation, "samplers"), [&](const json& sampler) {
      text_ += '{', put_members(sampler, {"input", "output", "interpolation"}), text_ += '}';
    });
    key("channels"), put_list(list(animation, "channels"), [&](const json& channel) {
      pointer_channels.back() += !moves_node(channel["target"]);
      text_ += '{', put_members(channel, {"sampler"}), key("target"), text_ += '{';
      put_members(channel["target"], {"node", "path"}), text_ += "}}";
    });
  }
  text_ += '}';
}

std::string Filter::run() {
  text_ = R"({"asset":{"version":"2.0"})";
  put_members(root_, {"scene"});
  key("bufferViews"), put_list(list(root_, "bufferViews"), [&](const json& view) { put_view(view); });
  text_.pop_back();  // and the view of those accessors that have none
  text_ += text_.back() == '[' ? "" : ",", text_ += R"({"buffer":0,"byteLength":1}])";
  key("accessors"), put_list(list(root_, "accessors"), [&](const json& one) { put_accessor(one); });
  key("meshes"), put_list(list(root_, "meshes"), [&](const json& mesh) { put_mesh(mesh); });
  key("nodes"), put_list(list(root_, "nodes"), [&](const json& node) { put_node(node); });
  for (const char* name : {"scenes", "skins"})
    key(name), put_list(list(root_, name), [&](const json& element) {
      text_ += '{', put_members(element, {"nodes", "joints", "inverseBindMatrices"}), text_ += '}';
    });
  const json* animations = member(root_, "animations");
  if (animations && animations->is_array())
    key("animations"), put_list(*animations, [&](const json& one) { put_animation(one); });
  return text_ + "}";
}

// Reserves memory for the end of tinygltf's JSON: a list that is built and one that is flattened double in
// size, to at most all values.
class LentReserve {
 public:
  explicit LentReserve(std::string_view text) {
    const auto begins = [](char c) { return c == ',' || c == '{' || c == '['; };
    const auto values = static_cast<size_t>(std::count_if(text.begin(), text.end(), begins)) + 64;
    const size_t size = 2 * 4 * sizeof(focal_view_json::json) * values;
    bytes_.reset(new std::byte[size]);  // normally not used
    focal_view_json::reserve = {bytes_.get(), bytes_.get(), bytes_.get() + size};
  }
  LentReserve(const LentReserve&) = delete;
  LentReserve& operator=(const LentReserve&) = delete;
  ~LentReserve() { focal_view_json::reserve = {}; }

 private:
  std::unique_ptr<std::byte[]> bytes_;
};

}  // namespace

GltfView view_of(json& checked_root) {
  Filter filter(checked_root);
  const std::string text = filter.run();
  GltfView view;
  if (checked_root.contains("buffers"))
    for (json& buffer : checked_root["buffers"]) {
      auto& source = view.buffers.emplace_back();
      source.length = checked_integer(buffer, "byteLength");
      if (buffer.contains("uri")) source.uri = std::move(buffer["uri"].get_ref<std::string&>());
    }
  view.broken_animations = std::move(filter.broken_animations);
  view.pointer_channels = std::move(filter.pointer_channels);
  tiny::TinyGLTF loader;
  std::string error, warning;
  bool is_read = false;
  {
    const LentReserve reserve(text);
    is_read = loader.LoadASCIIFromString(&view.model, &error, &warning, text.data(),
                                         static_cast<unsigned>(text.size()), "", tiny::NO_REQUIRE);
  }
  if (!is_read && error.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
  if (!is_read)
    throw Error(Status::invalid_file, "glTF: " + printable(error),
                "the file is malformed; export it again or run a glTF validator on it");
  return view;
}

bool has_view(const tiny::Model& model, const tiny::Accessor& accessor) {
  return static_cast<size_t>(accessor.bufferView) + 1 < model.bufferViews.size();
}

const tiny::Value* extension(const tiny::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

}  // namespace focal
