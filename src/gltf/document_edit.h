// Small edits of the caller's own glTF document: new parts are made as text, parsed, and swapped into place, so that the rest of
// the document is carried through untouched.
#pragma once
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "gltf/json.h"
#include "gltf/preflight.h"

namespace focal {

using OrderedJson = nlohmann::ordered_json;

// Swaps parsed text into `slot`; what was there is freed by the document that held the new part.
void put(OrderedJson& slot, const std::string& text);

// A member, made as an empty value of this kind when missing: references to other members of the object end then.
OrderedJson& member_or_new(OrderedJson& object, const char* key, OrderedJson::value_t kind);

// Takes a member out, if it is there; references to members of the object end then.
bool remove(OrderedJson& object, const std::string& key);

OrderedJson* find(OrderedJson& object, const char* key);  // null when there is none

// Appends a parsed element to a list of the root; its index.
size_t append_element(OrderedJson& root, const char* list, const std::string& text);

// The scene that is shown, or the first. A file without any gets one that shows all its roots. References to members of the root
// end here.
OrderedJson& shown_scene(OrderedJson& root);

// What the channels of an animation move. Animations are not looked at by parse_gltf: what is malformed moves node -1.
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
  void release(std::vector<size_t> nodes);  // they become empty
  size_t take();

 private:
  OrderedJson& root_;
  std::vector<size_t> free_;  // last first
};

// The file again, of the kind it came as. bin: takes the place of its BIN chunk, or becomes it; empty: as it was.
std::vector<std::byte> edited_file(const GltfContainer& container, const OrderedJson& root,
                                   std::span<const std::byte> bin = {});

}  // namespace focal
