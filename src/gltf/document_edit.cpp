#include "gltf/document_edit.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace focal {
namespace {

using Object = OrderedJson::object_t;

OrderedJson& fresh(OrderedJson& slot, OrderedJson::value_t kind) {
  OrderedJsonDocument old;
  slot.swap(old.root());
  return slot = OrderedJson(kind);
}

// Moves all members except `left_out` to an object with room for more. Values are swapped once there is a
// place for each.
void move_members(OrderedJson& object, size_t room, const std::string* left_out = nullptr) {
  OrderedJsonDocument rest;
  fresh(rest.root(), OrderedJson::value_t::object);
  auto &from = object.get_ref<Object&>(), &to = rest.root().get_ref<Object&>();
  to.reserve(from.size() + room);
  for (const auto& [name, value] : from)
    if (!left_out || name != *left_out) static_cast<Object::Container&>(to).emplace_back(name, nullptr);
  auto place = to.begin();
  for (auto& [name, value] : from)
    if (!left_out || name != *left_out) value.swap((place++)->second);
  object.swap(rest.root());
}

}  // namespace

OrderedJson& new_object(OrderedJson& slot) {
  constexpr size_t spare_room = 8;
  fresh(slot, OrderedJson::value_t::object).get_ref<Object&>().reserve(spare_room);
  return slot;
}

OrderedJson& new_list(OrderedJson& slot) { return fresh(slot, OrderedJson::value_t::array); }

OrderedJson& at(OrderedJson& object, const std::string& key) {
  if (OrderedJson* there = find(object, key.c_str())) return *there;
  auto& members = object.get_ref<Object&>();
  if (members.size() == members.capacity()) move_members(object, 8);
  return object[key];
}

OrderedJson& member_or_new(OrderedJson& object, const char* key, OrderedJson::value_t kind) {
  OrderedJson& value = at(object, key);
  return value.is_null() ? fresh(value, kind) : value;
}

bool remove(OrderedJson& object, const std::string& key) {
  if (!find(object, key.c_str())) return false;
  move_members(object, 4, &key);
  return true;
}

OrderedJson* find(OrderedJson& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

size_t append_element(OrderedJson& root, const char* list) {
  OrderedJson& elements = member_or_new(root, list, OrderedJson::value_t::array);
  elements.emplace_back(nullptr);
  new_object(elements.back());
  return elements.size() - 1;
}

size_t append_copy(OrderedJson& root, const char* list, size_t element) {
  const std::string text = root[list][element].dump();
  OrderedJsonDocument copy(std::as_bytes(std::span(text)), {});
  root[list].emplace_back(nullptr);
  root[list].back().swap(copy.root());
  return root[list].size() - 1;
}

double short_number(double finite) {
  std::array<char, 32> digits;
  char* const end = digits.data() + digits.size();
  double result = 0;
  std::from_chars(digits.data(), std::to_chars(digits.data(), end, static_cast<float>(finite)).ptr, result);
  return result;
}

void put_numbers(OrderedJson& object, const char* key, std::span<const double> values) {
  OrderedJson& list = new_list(at(object, key));
  for (const double value : values) list.push_back(short_number(value));
}

void put_vector(OrderedJson& object, const char* key, const Vector3& values) {
  put_numbers(object, key, std::span(values.data(), 3));
}

OrderedJson& shown_scene(OrderedJson& root) {
  // New members first: each may move the others, so no reference is taken before.
  for (const char* list : {"scenes", "nodes"}) member_or_new(root, list, OrderedJson::value_t::array);
  if (root["scenes"].empty()) at(root, "scene") = 0;
  const OrderedJson* chosen = find(root, "scene");
  OrderedJson &scenes = root["scenes"], &nodes = root["nodes"];
  if (!scenes.empty()) return scenes[chosen ? chosen->get<size_t>() : 0];
  std::vector<bool> is_child(nodes.size());
  for (OrderedJson& node : nodes)
    if (const OrderedJson* children = find(node, "children"))
      for (const OrderedJson& child : *children) is_child[child.get<size_t>()] = true;
  scenes.emplace_back(nullptr);
  new_object(scenes[0]);
  OrderedJson& roots = member_or_new(scenes[0], "nodes", OrderedJson::value_t::array);
  for (size_t node = 0; node < is_child.size(); ++node)
    if (!is_child[node]) roots.push_back(node);
  return scenes[0];
}

namespace {

// "/nodes/3/weights/0" is node 3, weights.
ChannelTarget pointed_at(const std::string& pointer) {
  constexpr std::string_view nodes_pointer = "/nodes/";
  ChannelTarget result;
  if (!pointer.starts_with(nodes_pointer)) return result;
  const char* const end = pointer.data() + pointer.size();
  const auto [rest, error] = std::from_chars(pointer.data() + nodes_pointer.size(), end, result.node);
  if (error != std::errc() || rest == end || *rest != '/') return {};
  result.path.assign(rest + 1, std::find(rest + 1, end, '/'));
  return result;
}

ChannelTarget target_of(OrderedJson& channel) {
  ChannelTarget one;
  OrderedJson* target = find(channel, "target");
  if (!target) return one;
  const OrderedJson *node = find(*target, "node"), *path = find(*target, "path");
  if (node && node->is_number_integer()) one.node = node->get<int64_t>();
  if (path && path->is_string()) one.path = path->get<std::string>();
  OrderedJson* extensions = find(*target, "extensions");
  OrderedJson* extension = extensions ? find(*extensions, "KHR_animation_pointer") : nullptr;
  const OrderedJson* pointer = extension ? find(*extension, "pointer") : nullptr;
  return pointer && pointer->is_string() ? pointed_at(pointer->get_ref<const std::string&>()) : one;
}

}  // namespace

std::vector<ChannelTarget> channel_targets(OrderedJson& animation) {
  std::vector<ChannelTarget> targets;
  OrderedJson* channels = find(animation, "channels");
  if (!channels || !channels->is_array()) return targets;
  for (OrderedJson& channel : *channels) targets.push_back(target_of(channel));
  return targets;
}

OrderedJson* focal_extras(OrderedJson& element) {
  OrderedJson* extras = find(element, "extras");
  return extras ? find(*extras, "focal") : nullptr;
}

void NodePool::release(const std::vector<size_t>& nodes) {
  for (const size_t node : nodes) new_object(root_["nodes"][node]);
  free_.insert(free_.end(), nodes.rbegin(), nodes.rend());
}

size_t NodePool::take() {
  if (free_.empty()) return append_element(root_, "nodes");
  const size_t node = free_.back();
  free_.pop_back();
  return node;
}

}  // namespace focal
