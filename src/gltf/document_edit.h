// Small edits of the caller's own glTF document, in place, so that the rest of it is preserved unchanged.
//
// nlohmann's destructors allocate memory, in noexcept functions, to flatten the nested values that they free,
// and a growing object copies its values. So nothing nested is assigned here: new values are created in
// place, and old ones are dismantled by OrderedJsonDocument.
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

// Replaces the value by an empty object or list.
OrderedJson& new_object(OrderedJson& slot);
OrderedJson& new_list(OrderedJson& slot);

// A member, created as null if missing, which invalidates references to other members of the object.
OrderedJson& at(OrderedJson& object, const std::string& key);

// The same, created as an empty value of this kind.
OrderedJson& member_or_new(OrderedJson& object, const char* key, OrderedJson::value_t kind);

// Removes a member if it exists; this invalidates references to members of the object.
bool remove(OrderedJson& object, const std::string& key);

OrderedJson* find(OrderedJson& object, const char* key);  // null if missing

// Appends an empty object, or a copy of an element, to a list of the root; returns its index.
size_t append_element(OrderedJson& root, const char* list);
size_t append_copy(OrderedJson& root, const char* list, size_t element);

// Sets a member to numbers, written as short as single precision allows.
void put_numbers(OrderedJson& object, const char* key, std::span<const double> values);
void put_vector(OrderedJson& object, const char* key, const Vector3& values);
double short_number(double finite);

// The default scene, or the first. A file without scenes gets one that shows all its roots. Invalidates
// references to members of the root.
OrderedJson& shown_scene(OrderedJson& root);

// The targets of an animation's channels, including those of KHR_animation_pointer. parse_gltf does not check
// animations: malformed channels have node -1.
struct ChannelTarget {
  int64_t node = -1;
  std::string path;
};
std::vector<ChannelTarget> channel_targets(OrderedJson& animation);

OrderedJson* focal_extras(OrderedJson& element);  // extras.focal, or null

// Nodes for new content: first those released by an earlier call (removing them from the list would renumber
// the others), then new ones.
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
