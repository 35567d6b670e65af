#include "skeleton_template.h"

#include <cmath>
#include <cstring>

#include "base/error.h"
#include "gltf/json.h"
#include "gltf/text.h"

namespace focal {
namespace {

using nlohmann::json;

[[noreturn]] void fail(const std::string& what) {
  throw Error(Status::invalid_argument, "the skeleton template " + what, "docs/rigs.md describes its form");
}

std::string text_of(const json& owner, const char* key) {
  const auto at = owner.find(key);
  if (at == owner.end() || at->is_null()) return "";
  if (!at->is_string()) fail(std::string("has a \"") + key + "\" that is no text");
  return at->get<std::string>();
}

std::vector<std::string> texts_of(const json& owner, const char* key) {
  std::vector<std::string> result;
  const auto at = owner.find(key);
  if (at == owner.end()) return result;
  if (!at->is_array()) fail(std::string("has a \"") + key + "\" that is no list");
  for (const json& one : *at) {
    if (!one.is_string()) fail(std::string("has a \"") + key + "\" that is no list of names");
    result.push_back(one.get<std::string>());
  }
  return result;
}

void check_keys(const json& owner, std::initializer_list<const char*> known) {
  for (const auto& [key, value] : owner.items()) {
    bool is_known = false;
    for (const char* one : known) is_known |= key == one;
    if (!is_known) fail("has an unknown \"" + printable(key) + "\"");  // a typo must not be passed over
  }
}

TemplateJoint joint_of(const json& from) {
  if (!from.is_object()) fail("has a joint that is no object");
  check_keys(from, {"name", "parent", "centre", "surface", "between", "share", "tip", "rest"});
  TemplateJoint joint;
  joint.name = text_of(from, "name"), joint.parent = text_of(from, "parent"),
  joint.tip = text_of(from, "tip");
  joint.centre = texts_of(from, "centre"), joint.surface = texts_of(from, "surface");
  joint.between = texts_of(from, "between");
  if (const auto share = from.find("share"); share != from.end()) {
    if (!share->is_number()) fail("has a \"share\" that is no number");
    joint.share = share->get<double>();
  }
  if (const auto rest = from.find("rest"); rest != from.end()) {
    if (!rest->is_array() || rest->size() != 3) fail("has a \"rest\" that is no list of three numbers");
    Vector3 way;
    for (int i = 0; i < 3; ++i) {
      if (!(*rest)[i].is_number()) fail("has a \"rest\" that is no list of three numbers");
      way[i] = (*rest)[i].get<double>();
    }
    if (!(way.norm() > 1e-9) || way.norm() > 1e9) fail("has a \"rest\" without a direction");
    joint.rest = way;
  }
  return joint;
}

JsonDocument json_of(const char* text) {
  try {
    return JsonDocument(std::as_bytes(std::span(text, std::strlen(text))), {.depth = 8, .values = 1'000'000});
  } catch (const Error& error) {
    throw Error(error.status(), std::string("the skeleton template: ") + error.what(),
                "it is JSON text; docs/rigs.md describes its form");
  }
}

}  // namespace

SkeletonTemplate parse_skeleton_template(const char* text) {
  const JsonDocument document = json_of(text);
  const json& root = document.root();
  if (!root.is_object() || text_of(root, "format") != "focal-skeleton-template")
    fail("has no \"format\": \"focal-skeleton-template\"");
  const auto version = root.find("version");
  if (version == root.end() || !version->is_number_integer() || version->get<int64_t>() != 1)
    throw Error(Status::unsupported, "the skeleton template is of another version", "write \"version\": 1");
  check_keys(root, {"format", "version", "symmetric", "joints"});
  SkeletonTemplate result;
  if (const auto symmetric = root.find("symmetric"); symmetric != root.end()) {
    if (!symmetric->is_boolean()) fail("has a \"symmetric\" that is neither true nor false");
    result.symmetric = symmetric->get<bool>();
  }
  const auto joints = root.find("joints");
  if (joints == root.end() || !joints->is_array()) fail("has no list of \"joints\"");
  for (const json& joint : *joints) result.joints.push_back(joint_of(joint));
  return result;
}

}  // namespace focal
