// Small edits of the caller's own glTF document, in place, so that the rest of it is carried through untouched.
//
// nlohmann's destructors take memory, in noexcept, to flatten the nested values that they free, and an object that grows copies its
// values. So nothing nested is assigned here: new values are made where they stay, and old ones are taken apart by OrderedJsonDocument.
#pragma once
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/matrix.h"
#include "gltf/json.h"

namespace focal {

using OrderedJson = nlohmann::ordered_json;

// An empty object or list in the place of what is there.
OrderedJson& new_object(OrderedJson& slot);
OrderedJson& new_list(OrderedJson& slot);

// A member, made as null when missing: references to other members of the object end then.
OrderedJson& at(OrderedJson& object, const std::string& key);

// The same, made as an empty value of this kind.
OrderedJson& member_or_new(OrderedJson& object, const char* key, OrderedJson::value_t kind);

// Takes a member out, if it is there; references to members of the object end then.
bool remove(OrderedJson& object, const std::string& key);

OrderedJson* find(OrderedJson& object, const char* key);  // null when there is none

// Appends an empty object to a list of the root, and a copy of an element; its index.
size_t append_element(OrderedJson& root, const char* list);
size_t append_copy(OrderedJson& root, const char* list, size_t element);

// A member of numbers, as short as single precision allows.
void put_numbers(OrderedJson& object, const char* key, std::span<const double> values);
void put_vector(OrderedJson& object, const char* key, const Vector3& values);
double short_number(double finite);

// The scene that is shown, or the first. A file without any gets one that shows all its roots. References to members of the root
// end here.
OrderedJson& shown_scene(OrderedJson& root);

// What the channels of an animation move, KHR_animation_pointer's too. Animations are not looked at by parse_gltf: what is malformed moves
// node -1.
struct ChannelTarget {
  int64_t node = -1;
  std::string path;
};
std::vector<ChannelTarget> channel_targets(OrderedJson& animation);

OrderedJson* focal_extras(OrderedJson& element);  // extras.focal, or null

// Nodes for new content: those that an earlier call left behind (taking them out of the list would renumber the others), then
// new ones.
class NodePool {
 public:
  explicit NodePool(OrderedJson& root) : root_(root) {}
  void release(const std::vector<size_t>& nodes);  // they become empty
  size_t take();

 private:
  OrderedJson& root_;
  std::vector<size_t> free_;  // last first
};

}  // namespace focal
