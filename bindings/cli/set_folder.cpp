// A SET: a folder with set.json and, for each mesh, NAME.glb and NAME.landmarks.json.
#include "set_folder.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command_error.h"
#include "files.h"
#include "json_text.h"
#include "paths.h"

namespace focal_cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Names = std::vector<std::string>;

Names names_in(const Json& document, const char* key) {
  return document.contains(key) ? document[key].get<Names>() : Names();
}

// set.json lists a pair once or twice, and some landmarks as their own mirror: those are in the middle.
std::map<std::string, std::string> both_ways(const std::map<std::string, std::string>& pairs) {
  std::map<std::string, std::string> mirror;
  for (const auto& [one, other] : pairs) {
    if (one == other) continue;
    mirror[one] = other;
    mirror[other] = one;
  }
  return mirror;
}

SetFolder set_of(const Json& document, const std::string& folder) {
  SetFolder set;
  set.folder = folder;
  set.name = document.value("name", text_of(path_of(folder).filename()));
  set.landmark_names = names_in(document, "landmark_names");
  if (document.contains("mirror")) {
    set.mirror = both_ways(document["mirror"].get<std::map<std::string, std::string>>());
  }
  for (const char* split : {"train", "test", "extra"}) {
    if (Names names = names_in(document, split); !names.empty()) set.splits[split] = std::move(names);
  }
  return set;
}

std::string list_of(const std::map<std::string, Names>& splits) {
  std::string list;
  for (const auto& [name, meshes] : splits) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

std::map<std::string, Landmark> SetFolder::marks(const std::string& mesh) const {
  const std::string path = folder + "/" + mesh + ".landmarks.json";
  std::map<std::string, Landmark> by_name;
  for (Landmark& mark : read_landmark_file(path).landmarks) {
    if (std::find(landmark_names.begin(), landmark_names.end(), mark.name) == landmark_names.end()) {
      throw CommandError(
          "'" + path + "': landmark '" + mark.name + "' is not a landmark of set '" + name + "'",
          "correct its name, or add it to landmark_names in set.json");
    }
    if (!mark.absent()) by_name.emplace(mark.name, std::move(mark));
  }
  return by_name;
}

Names SetFolder::meshes(const std::string& split, size_t limit) const {
  Names chosen;
  for (const auto& [name, meshes] : splits) {  // in the map's order test comes before train
    if (name == split) chosen = meshes;
  }
  if (split == "all") {
    for (const char* part : {"train", "test"}) {
      if (const auto found = splits.find(part); found != splits.end()) {
        chosen.insert(chosen.end(), found->second.begin(), found->second.end());
      }
    }
  }
  if (chosen.empty()) {
    throw CommandError("set '" + name + "' has no meshes in split '" + split + "'",
                       splits.empty() ? "list mesh names under \"train\" and \"test\" in set.json"
                                      : "its splits are: " + list_of(splits) + "; choose one with --split");
  }
  if (limit > 0 && chosen.size() > limit) chosen.resize(limit);
  return chosen;
}

SetFolder read_set(const std::string& folder) {
  std::error_code code;
  const std::string path = folder + "/set.json";
  if (!fs::is_directory(path_of(folder), code)) {
    throw CommandError("there is no folder '" + folder + "'",
                       "a set is a folder with set.json and its meshes");
  }
  if (!fs::exists(path_of(path), code)) {
    throw CommandError("folder '" + folder + "' has no set.json",
                       "a set needs set.json with landmark_names, train and test");
  }
  try {
    SetFolder set =
        set_of(parse_json<Json>(read_text_file(path)), text_of(path_of(folder).lexically_normal()));
    if (set.folder.size() > 1 && !path_of(set.folder).has_filename()) set.folder.pop_back();
    if (set.name.empty()) set.name = text_of(path_of(set.folder).filename());
    if (!set.landmark_names.empty()) return set;
  } catch (const Json::exception& error) {
    throw CommandError("'" + path + "' cannot be understood: " + std::string(error.what()),
                       "landmark_names, train and test are lists of names, mirror maps name to name");
  }
  throw CommandError("'" + path + "' names no landmarks", "list them under \"landmark_names\"");
}

}  // namespace focal_cli
