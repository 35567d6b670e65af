#include "gltf/document_edit.h"

#include "gltf/glb.h"

namespace focal {

void put(OrderedJson& slot, const std::string& text) {
  OrderedJsonDocument part(std::as_bytes(std::span(text)), {});
  slot.swap(part.root());
}

OrderedJson& member_or_new(OrderedJson& object, const char* key, OrderedJson::value_t kind) {
  OrderedJson& value = object[key];
  if (value.is_null()) value = OrderedJson(kind);
  return value;
}

// nlohmann's erase copies the keys that follow between destroyed members, and frees nested values inside noexcept: memory must
// not end in it. Here the values are swapped, once there is a place for each.
bool remove(OrderedJson& object, const std::string& key) {
  if (!find(object, key.c_str())) return false;
  OrderedJsonDocument rest(std::as_bytes(std::span("{}", 2)), {});
  auto& from = object.get_ref<OrderedJson::object_t&>();
  auto& to = rest.root().get_ref<OrderedJson::object_t&>();
  to.reserve(from.capacity());
  for (const auto& [name, value] : from)
    if (name != key) to.emplace(name, nullptr);
  for (auto& [name, value] : to) value.swap(from[name]);
  object.swap(rest.root());
  return true;
}

OrderedJson* find(OrderedJson& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

size_t append_element(OrderedJson& root, const char* list, const std::string& text) {
  OrderedJson& elements = member_or_new(root, list, OrderedJson::value_t::array);
  elements.emplace_back(nullptr);
  put(elements.back(), text);
  return elements.size() - 1;
}

OrderedJson& shown_scene(OrderedJson& root) {
  // New members first: each may move the others, so no reference is taken before.
  for (const char* list : {"scenes", "nodes"}) member_or_new(root, list, OrderedJson::value_t::array);
  if (root["scenes"].empty()) root["scene"] = 0;
  const OrderedJson* chosen = find(root, "scene");
  OrderedJson &scenes = root["scenes"], &nodes = root["nodes"];
  if (!scenes.empty()) return scenes[chosen ? chosen->get<size_t>() : 0];
  std::vector<bool> is_child(nodes.size());
  for (OrderedJson& node : nodes)
    if (const OrderedJson* children = find(node, "children"))
      for (const OrderedJson& child : *children) is_child[child.get<size_t>()] = true;
  scenes.emplace_back(OrderedJson::value_t::object);
  OrderedJson& roots = member_or_new(scenes[0], "nodes", OrderedJson::value_t::array);
  for (size_t node = 0; node < is_child.size(); ++node)
    if (!is_child[node]) roots.push_back(node);
  return scenes[0];
}

std::vector<ChannelTarget> channel_targets(OrderedJson& animation) {
  std::vector<ChannelTarget> targets;
  OrderedJson* channels = find(animation, "channels");
  if (!channels || !channels->is_array()) return targets;
  for (OrderedJson& channel : *channels) {
    ChannelTarget& one = targets.emplace_back();
    OrderedJson* target = find(channel, "target");
    if (!target) continue;
    const OrderedJson *node = find(*target, "node"), *path = find(*target, "path");
    if (node && node->is_number_integer()) one.node = node->get<int64_t>();
    if (path && path->is_string()) one.path = path->get<std::string>();
  }
  return targets;
}

OrderedJson* focal_extras(OrderedJson& element) {
  OrderedJson* extras = find(element, "extras");
  return extras ? find(*extras, "focal") : nullptr;
}

void NodePool::release(std::vector<size_t> nodes) {
  for (const size_t node : nodes) put(root_["nodes"][node], "{}");
  free_.insert(free_.end(), nodes.rbegin(), nodes.rend());
}

size_t NodePool::take() {
  if (free_.empty()) return append_element(root_, "nodes", "{}");
  const size_t node = free_.back();
  free_.pop_back();
  return node;
}

std::vector<std::byte> edited_file(const GltfContainer& container, const OrderedJson& root,
                                   std::span<const std::byte> bin) {
  const std::string_view before(reinterpret_cast<const char*>(container.json.data()), container.json.size());
  const bool indented = before.find('\n') != std::string_view::npos;
  const std::string text = root.dump(indented ? 2 : -1);
  if (!container.binary) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
  }
  if (bin.empty()) return glb_bytes(text, container.rest);
  std::vector<std::byte> chunks = bin_chunk(bin);
  constexpr size_t chunk_header = 8;
  size_t first = 0, behind = 0;  // where the old BIN chunk lies
  if (container.has_bin) {
    first = static_cast<size_t>(container.bin.data() - container.rest.data()) - chunk_header;
    behind = first + chunk_header + container.bin.size();
  }
  const auto& rest = container.rest;
  chunks.insert(chunks.begin(), rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(first));
  chunks.insert(chunks.end(), rest.begin() + static_cast<std::ptrdiff_t>(behind), rest.end());
  return glb_bytes(text, chunks);
}

}  // namespace focal
