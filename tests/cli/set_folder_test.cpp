// Sets: splits, mirrors both ways, and what is said about folders that are no sets.
#include "set_folder.h"

#include <doctest/doctest.h>

#include "command_error.h"
#include "scratch_folder.h"

using namespace focal_cli;

namespace {

constexpr const char* set_json = R"({"name": "beasts", "landmark_names": ["nose", "paw.L", "paw.R"],
  "mirror": {"paw.R": "paw.L", "nose": "nose"}, "train": ["a", "b", "c"], "test": ["d"]})";

std::string complaint(const std::string& folder) {
  try {
    read_set(folder);
  } catch (const CommandError& error) {
    CHECK_FALSE(error.hint.empty());
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("splits, all of them together, and the first few") {
  const ScratchFolder scratch;
  scratch.write("set.json", set_json);
  const SetFolder set = read_set(scratch.path.string() + "/");
  CHECK(set.name == "beasts");
  CHECK(set.mesh_path("a") == scratch / "a.glb");
  CHECK(set.meshes("train", 0) == std::vector<std::string>{"a", "b", "c"});
  CHECK(set.meshes("all", 0) == std::vector<std::string>{"a", "b", "c", "d"});
  CHECK(set.meshes("train", 2) == std::vector<std::string>{"a", "b"});
  CHECK(set.meshes("test", 9) == std::vector<std::string>{"d"});
  CHECK_THROWS_AS(set.meshes("extra", 0), CommandError);
}

TEST_CASE("a mirror holds both ways, and a landmark in the middle has none") {
  const ScratchFolder scratch;
  scratch.write("set.json", set_json);
  const std::map<std::string, std::string> expected = {{"paw.L", "paw.R"}, {"paw.R", "paw.L"}};
  CHECK(read_set(scratch.path.string()).mirror == expected);
}

TEST_CASE("marks: absent ones are left out, names the set lacks are refused") {
  const ScratchFolder scratch;
  scratch.write("set.json", set_json);
  const std::string head = R"({"format":"focal-landmarks","version":1,"mesh":"a.glb","landmarks":[)";
  scratch.write("a.landmarks.json",
                head + R"({"name":"nose","vertex":3},{"name":"paw.L","status":"absent"}]})");
  scratch.write("b.landmarks.json", head + R"({"name":"nsoe","vertex":3}]})");
  const SetFolder set = read_set(scratch.path.string());
  const auto marks = set.marks("a");
  REQUIRE(marks.size() == 1);
  CHECK(marks.at("nose").vertex == 3);
  CHECK_THROWS_AS(set.marks("b"), CommandError);
  CHECK_THROWS_AS(set.marks("c"), CommandError);
}

TEST_CASE("what is no set says why") {
  const ScratchFolder scratch;
  CHECK(complaint(scratch / "missing").find("no folder") != std::string::npos);
  CHECK(complaint(scratch.path.string()).find("no set.json") != std::string::npos);
  scratch.write("set.json", "{\"landmark_names\": [");
  CHECK(complaint(scratch.path.string()).find("cannot be understood") != std::string::npos);
  scratch.write("set.json", "[]");
  CHECK(complaint(scratch.path.string()).find("set.json") != std::string::npos);
  scratch.write("set.json", R"({"landmark_names": "nose"})");
  CHECK(complaint(scratch.path.string()).find("cannot be understood") != std::string::npos);
  scratch.write("set.json", R"({"train": ["a"]})");
  CHECK(complaint(scratch.path.string()).find("names no landmarks") != std::string::npos);
}
