// Files of other kinds, suffixes and folders: what goes in, and what lies beside what comes out.
#include <doctest/doctest.h>

#include <cstring>
#include <fstream>

#include "eggs.h"
#include "files.h"

namespace {

std::string file_text(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// A .glb as a .gltf whose buffer and picture lie in folders beside it.
void put_apart(const std::string& glb, const std::filesystem::path& folder, const std::string& name) {
  const std::string bytes = file_text(glb);
  uint32_t size = 0;
  std::memcpy(&size, bytes.data() + 12, 4);
  json root = json::parse(bytes.substr(20, size));
  root["buffers"][0]["uri"] = "data%20files/a%20b.bin";
  root["images"] = {{{"uri", "picture.png"}}};
  std::filesystem::create_directories(folder / "data files");
  focal_cli::write_file_atomically((folder / "data files" / "a b.bin").string(), bytes.substr(20 + size + 8));
  focal_cli::write_file_atomically((folder / "picture.png").string(), "pixels");
  focal_cli::write_file_atomically((folder / name).string(), root.dump());
}

}  // namespace

TEST_CASE("a .gltf that is written elsewhere takes the files beside it along") {
  const ScratchFolder from, to;
  put_apart(eggs().mesh(), from.path, "egg.gltf");
  const std::string line = "detect " + eggs().model() + " " + (from / "egg.gltf") + " -o ";
  CHECK(focal(line + (to / "marked.gltf")).status == 0);
  CHECK(file_text(to / "picture.png") == "pixels");
  CHECK(focal_json("info " + (to / "marked.gltf"))["vertices"] == 2 + 19 * 26);
  CHECK(focal(line + (to / "again.gltf")).status == 0);  // the same files are there already
  focal_cli::write_file_atomically(to / "picture.png", "other pixels");
  check_fails(line + (to / "third.gltf"), "another 'picture.png' is there already");
  CHECK(file_text(to / "picture.png") == "other pixels");
  CHECK(focal(line + (from / "beside.gltf")).status == 0);  // nothing to copy
}

TEST_CASE("suffixes count in any case, a .vrm is a .glb, and batch says what it skipped") {
  const ScratchFolder scratch, results;
  std::filesystem::copy_file(eggs().mesh(), scratch / "A.GLB");
  std::filesystem::copy_file(eggs().mesh(), scratch / "b.vrm");
  focal_cli::write_file_atomically(scratch / "c.obj", "v 0 0 0");
  const json report =
      focal_json("batch " + eggs().model() + " " + scratch.path.string() + " -o " + results.path.string());
  CHECK(report["done"] == 2);
  REQUIRE(report["skipped"].size() == 1);
  CHECK(report["skipped"][0].get<std::string>().ends_with("c.obj"));
  CHECK(focal_json("info " + (results / "A.GLB"))["vertices"] == 2 + 19 * 26);
  CHECK(focal_json("info " + (results / "b.vrm"))["kind"] == "mesh");
  CHECK(focal("detect " + eggs().model() + " " + (scratch / "A.GLB") + " -o " + (results / "X.Glb")).status ==
        0);
  check_fails("detect " + eggs().model() + " " + (scratch / "A.GLB") + " -o " + (results / "x.GLTF"),
              "ends in .gltf");
  check_fails("info " + (scratch / "c.obj"), "OBJ file");
}

TEST_CASE("options that do nothing are not accepted") {
  CHECK(focal("info a.glb --seed 1").status == 2);
  CHECK(focal("batch M F -o R --keep-failed").status == 2);
  CHECK(focal("train --rigs a.glb -o m --limit 3").status == 2);
  CHECK(focal("train --rigs a.glb -o m --template t.json").status == 2);
  const ScratchFolder scratch;
  focal_cli::write_file_atomically(scratch / "a.csv", "name,x,y,z\na,0,0,0\n");
  check_fails("convert " + (scratch / "a.csv") + " " + (scratch / "b.csv") + " --lenient", "are for meshes");
}
