// A SET: a folder with set.json and, for each mesh, NAME.glb and NAME.landmarks.json.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "landmark_files.h"

namespace focal_cli {

struct SetFolder {
  std::string folder;
  std::string name;  // of the set, else of the folder
  std::vector<std::string> landmark_names;
  std::map<std::string, std::string> mirror;               // each landmark that has a mirror, both ways
  std::map<std::string, std::vector<std::string>> splits;  // train, test, extra: names of meshes

  std::string mesh_path(const std::string& mesh) const { return folder + "/" + mesh + ".glb"; }
  // The marks of one mesh by name; a landmark that is not there is absent on it.
  std::map<std::string, Landmark> marks(const std::string& mesh) const;
  // The first `limit` meshes (0: all) of a split; "all" is train and test together.
  std::vector<std::string> meshes(const std::string& split, size_t limit) const;
};

SetFolder read_set(const std::string& folder);

}  // namespace focal_cli
