#include "skeleton/template_file.h"

#include <cstring>

#include "base/error.h"
#include "gltf/fields.h"
#include "gltf/json.h"
#include "gltf/text.h"

namespace focal {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& what) {
  throw Error(Status::invalid_argument, "the skeleton template " + what, "docs/rigs.md describes its form");
}
[[noreturn]] void refuse(const char* key, const char* what) {
  refuse(std::string("has a \"") + key + "\" that is " + what);
}

std::string text_of(const json& owner, const char* key) {
  const json* const text = member(owner, key);
  if (!text || text->is_null()) return "";
  if (!text->is_string()) refuse(key, "no text");
  return text->get<std::string>();
}

std::vector<std::string> texts_of(const json& owner, const char* key) {
  const json* const texts = member(owner, key);
  if (!texts) return {};
  if (!texts->is_array()) refuse(key, "no list");
  std::vector<std::string> result;
  for (const json& one : *texts) {
    if (!one.is_string()) refuse(key, "no list of names");
    result.push_back(one.get<std::string>());
  }
  return result;
}

void check_keys(const json& owner, std::initializer_list<const char*> known) {
  for (const auto& [key, value] : owner.items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      refuse("has an unknown \"" + printable(key) + "\"");  // a typo must not be passed over
}

Vector3 direction_of(const json& rest) {
  const auto is_number = [](const json& one) { return one.is_number(); };
  if (!rest.is_array() || rest.size() != 3 || !std::all_of(rest.begin(), rest.end(), is_number))
    refuse("rest", "no list of three numbers");
  const Vector3 way(rest[0].get<double>(), rest[1].get<double>(), rest[2].get<double>());
  if (!(way.norm() > 1e-9) || way.norm() > 1e9) refuse("has a \"rest\" without a direction");
  return way;
}

TemplateJoint joint_of(const json& from) {
  if (!from.is_object()) refuse("has a joint that is not an object");
  check_keys(from, {"name", "parent", "centre", "surface", "between", "share", "tip", "rest"});
  TemplateJoint joint;
  joint.name = text_of(from, "name"), joint.parent = text_of(from, "parent");
  joint.tip = text_of(from, "tip");
  joint.centre = texts_of(from, "centre"), joint.surface = texts_of(from, "surface");
  joint.between = texts_of(from, "between");
  if (const json* share = member(from, "share")) {
    if (!share->is_number()) refuse("share", "no number");
    joint.share = share->get<double>();
  }
  if (const json* rest = member(from, "rest")) joint.rest = direction_of(*rest);
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
    refuse("has no \"format\": \"focal-skeleton-template\"");
  const json* const version = member(root, "version");
  if (!version || !version->is_number_integer() || version->get<int64_t>() != 1)
    throw Error(Status::unsupported, "the skeleton template is of another version", "write \"version\": 1");
  check_keys(root, {"format", "version", "symmetric", "joints"});
  SkeletonTemplate result;
  if (const json* symmetric = member(root, "symmetric")) {
    if (!symmetric->is_boolean()) refuse("symmetric", "neither true nor false");
    result.symmetric = symmetric->get<bool>();
  }
  const json* const joints = member(root, "joints");
  if (!joints || !joints->is_array()) refuse("has no list of \"joints\"");
  for (const json& joint : *joints) result.joints.push_back(joint_of(joint));
  return result;
}

SkeletonTemplate template_of_model(const std::string& text, const std::vector<std::string>& landmarks) {
  try {
    const SkeletonTemplate result = parse_skeleton_template(text.c_str());
    check_template(result, landmarks);
    return result;
  } catch (const Error& error) {
    throw Error(Status::invalid_file, std::string("section TMPL: ") + error.what(), "train the model again");
  }
}

}  // namespace focal
