// Writes VRM 1.0: the humanoid bones and the meta data of an avatar.
#include <algorithm>

#include "base/error.h"
#include "gltf/document_edit.h"
#include "gltf/opened.h"

namespace focal {
namespace {

constexpr const char* required_bones[] = {"hips",          "spine",         "head",          "leftUpperLeg",
                                          "leftLowerLeg",  "leftFoot",      "rightUpperLeg", "rightLowerLeg",
                                          "rightFoot",     "leftUpperArm",  "leftLowerArm",  "leftHand",
                                          "rightUpperArm", "rightLowerArm", "rightHand"};
constexpr const char* license_url = "https://vrm.dev/licenses/1.0/";

void check_bones(std::span<const std::string> roles) {
  std::string missing;
  for (const char* bone : required_bones)
    if (std::find(roles.begin(), roles.end(), bone) == roles.end())
      missing += (missing.empty() ? "" : ", ") + std::string(bone);
  if (!missing.empty())
    throw Error(Status::invalid_argument, "the skeleton has no joint for " + missing + ", which VRM requires",
                "use a model of humanoids; joints are recognised by their names and the hierarchy");
}

// The nodes of the joints: as read from this file, or those of the skin that has joints of these names in
// this order.
std::vector<size_t> nodes_of(OrderedJson& root, const std::vector<Joint>& joints) {
  std::vector<size_t> nodes;
  if (joints[0].node >= 0) {
    for (const Joint& joint : joints) nodes.push_back(static_cast<size_t>(joint.node));
    return nodes;
  }
  OrderedJson* skins = find(root, "skins");
  for (size_t s = 0; skins && s < skins->size(); ++s) {
    const OrderedJson& list = (*skins)[s]["joints"];
    nodes.clear();
    for (size_t j = 0; j < list.size() && list.size() == joints.size(); ++j) {
      const auto node = list[j].get<size_t>();
      const OrderedJson* name = find(root["nodes"][node], "name");
      if (!name || !is_text(*name, joints[j].name)) break;
      nodes.push_back(node);
    }
    if (nodes.size() == joints.size()) return nodes;
  }
  throw Error(Status::invalid_argument, "the file lacks the joints of the skeleton",
              "write the skeleton into it first");
}

bool is_filled_text(const OrderedJson& value) {
  const auto* text = value.get_ptr<const std::string*>();
  return text && !text->empty();
}

// Fills in what VRM requires.
void complete_meta(OrderedJson& meta) {
  if (!meta.is_object())
    throw Error(Status::invalid_file, "the meta data is not a JSON object",
                R"(write {"name": "...", "authors": ["..."]})");
  const OrderedJson* name = find(meta, "name");
  const bool has_name = name && is_filled_text(*name);
  const OrderedJson* authors = find(meta, "authors");
  const bool has_authors = authors && authors->is_array() && !authors->empty() &&
                           std::all_of(authors->begin(), authors->end(), is_filled_text);
  if (!has_name || !has_authors)
    throw Error(Status::invalid_argument, "VRM's meta data needs a name and a list of authors",
                R"(write {"name": "...", "authors": ["..."]})");
  if (!find(meta, "licenseUrl")) at(meta, "licenseUrl") = license_url;
}

void declare(OrderedJson& root) {
  OrderedJson& used = member_or_new(root, "extensionsUsed", OrderedJson::value_t::array);
  for (const OrderedJson& one : used)
    if (is_text(one, "VRMC_vrm")) return;
  used.push_back("VRMC_vrm");
}

}  // namespace

void GltfDocument::add_vrm(const std::vector<Joint>& joints, std::span<const std::string> roles,
                           std::string_view meta) {
  if (!is_binary())
    throw Error(Status::invalid_argument, "the mesh is from a .gltf file, but VRM requires a .glb",
                "export it as .glb");
  check_bones(roles);
  OrderedJsonDocument given(std::as_bytes(std::span(meta)), {});
  complete_meta(given.root());
  OrderedJson& root = edited().document.root();
  const std::vector<size_t> nodes = nodes_of(root, joints);
  declare(root);
  OrderedJson& extensions = member_or_new(root, "extensions", OrderedJson::value_t::object);
  OrderedJson& vrm = new_object(at(extensions, "VRMC_vrm"));
  at(vrm, "specVersion") = "1.0";
  at(vrm, "meta").swap(given.root());
  OrderedJson& bones = new_object(at(new_object(at(vrm, "humanoid")), "humanBones"));
  for (size_t j = 0; j < roles.size(); ++j)
    if (!roles[j].empty()) at(new_object(at(bones, roles[j])), "node") = nodes[j];
}

}  // namespace focal
