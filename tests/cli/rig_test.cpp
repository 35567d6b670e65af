// Rigs from the command: the verdict on them, teachers that cannot teach, and the wrap to look at.
#include <doctest/doctest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "command.h"
#include "files.h"

#ifdef FOCAL_CREATURES
namespace {

namespace fs = std::filesystem;

// Sample humanoids, and a quick model of one of them, made once for all tests of this file.
struct Humanoids {
  ScratchFolder scratch;
  json trained;
  Humanoids() {
    const std::string line = "\"" FOCAL_CREATURES "\" " + scratch.path.string() +
                             " --family humanoid --train 1 --test 1 > " + (scratch / "log");
    REQUIRE(std::system(line.c_str()) == 0);
    const std::string other = "\"" FOCAL_CREATURES "\" " + scratch.path.string() +
                              " --family hand --train 1 --test 0 > " + (scratch / "log");
    REQUIRE(std::system(other.c_str()) == 0);
    trained = focal_json("train --rigs " + teacher() + " -o " + model() +
                         " --eigenpairs 60 --trees 6 --proxy 1000");
  }
  std::string teacher() const { return scratch / "humanoid/humanoid_00.rig.glb"; }
  std::string mesh() const { return scratch / "humanoid/humanoid_01.glb"; }
  // A hand is no humanoid.
  std::string foreign() const { return scratch / "hand/hand_00.glb"; }
  std::string model() const { return scratch / "rig.focal"; }
};

const Humanoids& humanoids() {
  static const Humanoids one;
  return one;
}

// A file of the scratch folder with every `from` in it become `to`, which is as long.
std::string edited(const ScratchFolder& scratch, const std::string& file, const std::string& name,
                   const std::string& from, const std::string& to) {
  std::string text = focal_cli::read_text_file(file);
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return scratch.write(name, text);
}

// A .glb of the scratch folder with what change(document) adds, and with a mesh of a ground, six by six.
template <class Change>
std::string with_ground(const ScratchFolder& scratch, const std::string& file, const std::string& name,
                        Change&& change) {
  const std::string glb = focal_cli::read_text_file(file);
  const auto u32 = [&](size_t at) {
    uint32_t value;
    std::memcpy(&value, glb.data() + at, 4);
    return value;
  };
  json root = json::parse(glb.substr(20, u32(12)));
  const auto add = [&](const char* list, json element) {
    root[list].push_back(std::move(element));
    return root[list].size() - 1;
  };
  const size_t buffer =
      add("buffers", {{"byteLength", 60},
                      {"uri",
                       "data:application/octet-stream;base64,"
                       "AABAwG8SA7sAAEDAAABAwG8SA7sAAEBAAABAQG8SA7sAAEDAAABAQG8SA7sAAEBAAAABAAIAAQADAAIA"}});
  const size_t view = add("bufferViews", {{"buffer", buffer}, {"byteLength", 48}});
  const size_t indices = add("bufferViews", {{"buffer", buffer}, {"byteOffset", 48}, {"byteLength", 12}});
  const size_t positions = add("accessors", {{"bufferView", view},
                                             {"componentType", 5126},
                                             {"type", "VEC3"},
                                             {"count", 4},
                                             {"min", {-3, -0.002F, -3}},
                                             {"max", {3, -0.002F, 3}}});
  const size_t corners =
      add("accessors", {{"bufferView", indices}, {"componentType", 5123}, {"type", "SCALAR"}, {"count", 6}});
  const size_t mesh =
      add("meshes",
          {{"primitives", json::array({{{"attributes", {{"POSITION", positions}}}, {"indices", corners}}})}});
  root["scenes"][0]["nodes"].push_back(add("nodes", {{"name", "Ground"}, {"mesh", mesh}}));
  change(root);
  std::string text = root.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string rest = glb.substr(20 + u32(12));
  const auto bytes_of = [](size_t number) {
    const auto value = static_cast<uint32_t>(number);
    return std::string(reinterpret_cast<const char*>(&value), 4);
  };
  return scratch.write(name, glb.substr(0, 8) + bytes_of(20 + text.size() + rest.size()) +
                                 bytes_of(text.size()) + glb.substr(16, 4) + text + rest);
}

json document_of(const std::string& file) {
  const std::string glb = focal_cli::read_text_file(file);
  uint32_t size;
  std::memcpy(&size, glb.data() + 12, 4);
  return json::parse(glb.substr(20, size));
}

}  // namespace

TEST_CASE("rig: scenery is reported, changes nothing and stays as it was") {
  const ScratchFolder scratch;
  const auto rigged = [&](const std::string& mesh, const std::string& name) {
    return focal_json("rig " + humanoids().model() + " " + mesh + " -o " + (scratch / name) +
                      " --keep-failed");
  };
  const json alone = rigged(humanoids().mesh(), "alone.glb");
  for (const bool hidden : {false, true}) {
    const std::string scene = with_ground(scratch, humanoids().mesh(), "scene.glb", [&](json& root) {
      if (!hidden) return;
      root["nodes"].back()["extensions"] = {{"KHR_node_visibility", {{"visible", false}}}};
      root["extensionsUsed"] = root["extensionsRequired"] = {"KHR_node_visibility"};
    });
    const json info = focal_json("info " + scene);
    REQUIRE(info["left_out"].size() == 1);
    CHECK(info["left_out"][0]["name"] == "node 'Ground'");
    CHECK(info["left_out"][0]["reason"] == (hidden ? "hidden" : "sheet"));
    CHECK(info["left_out"][0]["whole_node"] == true);
    const json report = rigged(scene, "rigged.glb");
    CHECK(report["joints"] == alone["joints"]);
    CHECK(report["quality"] == alone["quality"]);
    const json before = document_of(scene), after = document_of(scratch / "rigged.glb");
    const size_t ground = before["nodes"].size() - 1;
    CHECK(after["nodes"][ground] == before["nodes"][ground]);
    CHECK(after["meshes"].back()["primitives"] == before["meshes"].back()["primitives"]);
    CHECK(after.value("extensionsRequired", json()) == before.value("extensionsRequired", json()));
  }
  const std::string scene = with_ground(scratch, humanoids().mesh(), "scene.glb", [](const json&) {});
  CHECK(focal_json("info --keep-scenery " + scene)["left_out"].empty());
  CHECK(focal_json("info --keep-scenery " + scene)["components"] == 2);
}

TEST_CASE("train: a teacher's scenery does not teach") {
  const ScratchFolder scratch;
  const std::string scene = with_ground(scratch, humanoids().teacher(), "scene.glb", [](const json&) {});
  focal_json("train --rigs " + scene + " -o " + (scratch / "scene.focal") +
             " --eigenpairs 60 --trees 6 --proxy 1000");
  CHECK(focal_cli::read_text_file(scratch / "scene.focal") == focal_cli::read_text_file(humanoids().model()));
}

TEST_CASE("rig: a verdict in JSON and in words") {
  const ScratchFolder scratch;
  const std::string line =
      "rig " + humanoids().model() + " " + humanoids().mesh() + " -o " + (scratch / "a.glb");
  const json report = focal_json(line);
  CHECK(keys_of(report) == Keys{"mesh", "output", "verdict", "quality", "guessed_joints", "joints", "weights",
                                "category_fit", "warnings", "seconds"});
  CHECK((report["verdict"] == "good" || report["verdict"] == "check"));
  CHECK(report["quality"] > 0);
  CHECK(report["quality"] <= 1);
  CHECK(report["guessed_joints"] <= report["joints"].size());
  CHECK(report["output"] == scratch / "a.glb");
  CHECK(fs::exists(scratch / "a.glb"));
  const Run run = focal(line);
  CHECK(run.status == 0);
  CHECK(run.out.find("\nverdict: " + report["verdict"].get<std::string>() + ", quality ") !=
        std::string::npos);
  CHECK((run.out.find("\nhint: ") != std::string::npos) == (report["verdict"] == "check"));
  size_t guesses = 0;
  for (const json& warning : report["warnings"])
    guesses += warning.get<std::string>().find("is a guess") != std::string::npos;
  CHECK(guesses <= 1);
}

TEST_CASE("rig: what failed ends with 1 and writes nothing, unless it is to be kept") {
  const ScratchFolder scratch;
  const std::string out = scratch / "a.glb";
  const std::string line = "rig " + humanoids().model() + " " + humanoids().foreign() + " -o " + out;
  const Run run = focal(line + " --json");
  CAPTURE(run.out);
  CAPTURE(run.err);
  CHECK(run.status == 1);
  const json report = json::parse(run.out);
  CHECK(report["verdict"] == "failed");
  CHECK(report["output"].is_null());
  CHECK_FALSE(report["warnings"].empty());
  CHECK_FALSE(fs::exists(out));
  CHECK(run.err.find("no file is written without --keep-failed") != std::string::npos);
  CHECK(run.err.find("\nhint: ") != std::string::npos);
  const Run kept = focal(line + " --keep-failed");
  CHECK(kept.status == 1);
  CHECK(kept.out.find("verdict: failed") != std::string::npos);
  CHECK(fs::exists(out));
}

TEST_CASE("batch: a verdict a file and their count") {
  const ScratchFolder scratch, results;
  fs::create_directory(scratch.path / "in");
  fs::copy_file(humanoids().foreign(), scratch / "in/hand.glb");
  fs::copy_file(humanoids().mesh(), scratch / "in/man.glb");
  const std::string line =
      "batch " + humanoids().model() + " " + (scratch / "in") + " -o " + results.path.string() + " --rig";
  const Run run = focal(line + " --json");
  CHECK(run.status == 1);
  const json report = json::parse(run.out);
  CHECK(keys_of(report) == Keys{"meshes", "done", "kept", "failed", "skipped", "verdicts"});
  CHECK(report["failed"] == 1);
  CHECK(report["verdicts"]["failed"] == 1);
  CHECK(report["verdicts"]["good"].get<int>() + report["verdicts"]["check"].get<int>() == 1);
  CHECK(report["meshes"][0]["verdict"] == "failed");
  CHECK(report["meshes"][0]["status"] == "failed");
  CHECK_FALSE(fs::exists(results / "hand.glb"));
  CHECK(fs::exists(results / "man.glb"));
  const Run words = focal(line);
  CHECK(words.out.find("man.glb: there already") != std::string::npos);
  CHECK(words.out.find("rigs: 0 good, 0 to check, 1 failed") != std::string::npos);
}

TEST_CASE("train on rigs: what is odd about the teachers is said, with their files") {
  CHECK(humanoids().trained["warnings"] == json::array());
  const ScratchFolder scratch;
  const std::string sided = edited(scratch, humanoids().teacher(), "sided.glb", "\"left", "\"qrst");
  const std::string other = edited(scratch, sided, "other.glb", "\"right", "\"uvwxy");
  check_fails("train --rigs " + humanoids().teacher() + " " + other + " -o " + (scratch / "a.focal"),
              "2 (other.glb) share");
  CHECK_FALSE(fs::exists(scratch / "a.focal"));
}

TEST_CASE("info and convert: what is analysed, and the wrap to look at") {
  const ScratchFolder scratch;
  const std::string mesh = humanoids().mesh();
  CHECK(focal_json("info " + mesh)["analysed"] == "as-is");
  CHECK(focal_json("info " + mesh + " --surface wrapped")["analysed"] == "wrapped");
  CHECK(focal("info " + mesh + " --surface paper").status == 2);
  const json report = focal_json("convert " + mesh + " " + (scratch / "wrap.glb"));
  CHECK(keys_of(report) == Keys{"in", "out", "vertices", "triangles", "analysed"});
  CHECK(report["triangles"] > 500);
  const json wrap = focal_json("info " + (scratch / "wrap.glb"));
  CHECK(wrap["components"] == 1);
  CHECK(wrap["boundary_loops"] == 0);
  CHECK(wrap["triangles"] == report["triangles"]);
  const Run words = focal("convert " + mesh + " " + (scratch / "wrap.glb"));
  CHECK(words.out.find("closed surface around") != std::string::npos);
  check_fails("convert " + mesh + " " + (scratch / "wrap.gltf"), ".glb");
}

TEST_CASE("rig: weights only, the joints of the file stay to the bit") {
  const ScratchFolder scratch;
  const std::string before = humanoids().teacher(), after = scratch / "kept.glb";
  const json report = focal_json("rig --keep-skeleton " + before + " -o " + after);
  CHECK(keys_of(report) == Keys{"mesh", "output", "joints", "weights", "warnings", "seconds"});
  CHECK(report["joints"].size() == humanoids().trained["joints"].size());
  CHECK(report["weights"]["unweighted_vertices"] == 0);
  const json old_file = document_of(before), new_file = document_of(after);
  for (const char* kept : {"nodes", "skins", "scenes", "animations"}) CHECK(old_file[kept] == new_file[kept]);
  CHECK(old_file["meshes"] != new_file["meshes"]);
  check_fails("rig --keep-skeleton " + humanoids().mesh() + " -o " + after, "no skin");
  check_fails("rig --keep-skeleton model.focal " + before + " -o " + after, "needs no model");
  check_fails("rig --keep-skeleton " + before + " -o " + after + " --symmetric", "--symmetric");
}

TEST_CASE("rig: a pinned joint lies where it is put") {
  const ScratchFolder scratch;
  const std::string rig =
      "rig " + humanoids().model() + " " + humanoids().mesh() + " --keep-failed -o " + (scratch / "out.glb");
  const auto joint = [](const json& report, const std::string& name) {
    for (const json& one : report["joints"])
      if (one["name"] == name) return one;
    return json();
  };
  const json pinned = focal_json(rig + " --pin leftLowerArm=0.5,1.25,0.125 --pin head=0,1.5,0");
  CHECK(joint(pinned, "leftLowerArm")["position"] == json({0.5, 1.25, 0.125}));
  CHECK(joint(pinned, "leftLowerArm")["confidence"] == 1);
  CHECK(joint(pinned, "head")["position"] == json({0, 1.5, 0}));
  check_fails(rig + " --pin noSuchJoint=0,0,0", "noSuchJoint");
  check_fails(rig + " --pin head=0,0", "head=0,0");
}

TEST_CASE("rig: the pose that the file shows, and both sides alike") {
  const ScratchFolder scratch;
  const std::string rig = "rig " + humanoids().model() + " " + humanoids().mesh() + " --keep-failed -o ";
  const auto written = [&](const std::string& options) {
    focal_json(rig + (scratch / "out.glb") + options);
    return focal_cli::read_text_file(scratch / "out.glb");
  };
  const std::string as_it_is = written(""), rest = written(" --pose teachers"), t = written(" --pose t");
  CHECK(written(" --pose mesh") == as_it_is);
  CHECK(written(" --rest-pose") == rest);
  CHECK((rest != as_it_is && t != rest && written(" --pose a") != t));
  CHECK(written(" --drop-helpers") == as_it_is);  // the sample has none
  CHECK(written(" --symmetric") != as_it_is);
  const std::string rigged = scratch / "out.glb";
  check_fails("rig --keep-skeleton " + rigged + " -o " + (scratch / "b.glb") + " --pose t", "--pose");
  check_fails("rig --keep-skeleton " + rigged + " -o " + (scratch / "b.glb") + " --drop-helpers",
              "--drop-helpers");
}

TEST_CASE("stock models: used by name, listed, and named in the first error") {
  const ScratchFolder scratch;
  const std::string copy = scratch / "models/tiny.focal";
  std::filesystem::create_directories(scratch / "models");
  std::filesystem::copy_file(humanoids().model(), copy);
  scratch.write("models/broken.focal", "no model");
  const std::string variable = "FOCAL_MODELS='" + (scratch / "models") + "'";
  const auto list = json::parse(focal("models --json", variable).out)["models"];
  const auto of_name = [](const json& models, const std::string& name) {
    for (const json& one : models)
      if (one["name"] == name) return one;
    return json();
  };
  CHECK(of_name(list, "tiny")["joints"] == humanoids().trained["joints"]);
  CHECK(of_name(list, "tiny")["landmarks"] == humanoids().trained["landmarks"]);
  CHECK(of_name(list, "tiny")["file"] == copy);
  CHECK(of_name(list, "broken").contains("error"));
  CHECK(of_name(json::parse(focal("doctor --json", variable).out)["stock_models"], "tiny")["file"] == copy);
  CHECK(focal("doctor", variable).out.find("tiny") != std::string::npos);

  const std::string out = scratch / "out.glb";
  CHECK(focal("rig tiny " + humanoids().mesh() + " --keep-failed --quiet -o " + out, variable)
            .err.find("no model") == std::string::npos);
  CHECK(std::filesystem::exists(out));
  CHECK(json::parse(focal("info tiny --json", variable).out)["kind"] == "model");

  Run wrong = focal("rig dragon " + humanoids().mesh() + " -o " + out, variable);
  CHECK(wrong.status == 1);
  CHECK(wrong.err.find("no model file or stock model 'dragon'") != std::string::npos);
  CHECK(wrong.err.find("tiny") != std::string::npos);
  wrong = focal("rig " + humanoids().mesh() + " -o " + out, variable);
  CHECK(wrong.status == 2);
  CHECK(wrong.err.find("tiny") != std::string::npos);
  CHECK(focal("info dragon", variable).err.find("cannot open 'dragon'") != std::string::npos);
  check_fails("rig no/such.focal " + humanoids().mesh() + " -o " + out, "no/such.focal");
}
#endif
