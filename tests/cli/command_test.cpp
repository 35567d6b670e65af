// The built command from outside: exit status, the keys of every JSON document, what bad input is answered
// with.
#include "command.h"

#include <doctest/doctest.h>

#include "eggs.h"
#include "files.h"
#include "landmark_files.h"
#include "scratch_folder.h"
#include "tiny_set.h"

namespace {

const Keys summary_keys = {
    "marks",          "mean_edges",          "median_edges",  "p95_edges",      "mean_root_area_x100",
    "within_4_edges", "over_10_edges",       "swap_rate",     "flipped_meshes", "absent",
    "calibration",    "category_fit_median", "seconds_median"};

void check_summary(const json& report) {
  for (const std::string& key : summary_keys) {
    CAPTURE(key);
    CHECK(report.contains(key));
  }
  CHECK(keys_of(report["absent"]) == Keys{"precision", "recall"});
  CHECK(keys_of(report["calibration"]) ==
        Keys{"expected_calibration_error", "auroc", "sure_count", "sure_within_4_edges", "bins"});
  CHECK(report["calibration"]["bins"].size() == 10);
}

}  // namespace

TEST_CASE("wrong usage ends with 2 and says so on stderr only") {
  for (const std::string arguments :
       {"", "dance", "train", "train x", "detect a", "doctor --what", "train x -o y --preset best",
        "doctor --threads -1", "doctor --threads x", "train x -o y --limit 0", "doctor --backend gpu",
        "doctor --seed -3", "convert a.csv", "cross-validate x --folds 1", "train x -o y --sampling-rate 1.5",
        "rig a b"}) {
    CAPTURE(arguments);
    const Run run = focal(arguments);
    CHECK(run.status == 2);
    CHECK(run.out.empty());
    CHECK_FALSE(run.err.empty());
  }
}

TEST_CASE("every verb explains itself and has the common options") {
  CHECK(focal("--version").out.starts_with("focal "));
  const Run all = focal("--help");
  CHECK(all.status == 0);
  for (const std::string verb :
       {"train", "detect", "eval", "cross-validate", "info", "convert", "models", "doctor"}) {
    CAPTURE(verb);
    CHECK(all.out.find("\n  " + verb) != std::string::npos);
    const Run run = focal(verb + " --help");
    CHECK(run.status == 0);
    CHECK(run.err.empty());
    for (const char* option : {"--json", "--quiet", "--threads", "--memory-budget", "--backend"})
      CHECK(run.out.find(option) != std::string::npos);
    const bool makes_choices = verb != "info" && verb != "convert" && verb != "doctor";
    CHECK((run.out.find("--seed") != std::string::npos) == makes_choices);
  }
}

TEST_CASE("doctor, info and convert: keys") {
  const json doctor = focal_json("doctor --threads 1");
  CHECK(keys_of(doctor) ==
        Keys{"version", "backend", "threads", "limits", "stock_models", "peak_memory_bytes"});
  CHECK(doctor["threads"]["used"] == 1);
  const ScratchFolder scratch;
  write_tiny_set(scratch, 1, 0);
  const json info = focal_json("info " + (scratch / "egg0.glb"));
  CHECK(keys_of(info) == Keys{"kind",
                              "file",
                              "vertices",
                              "triangles",
                              "surface_vertices",
                              "surface_triangles",
                              "analysed",
                              "mean_edge_length",
                              "surface_area",
                              "invalid_triangles",
                              "degenerate_triangles",
                              "flipped_triangles",
                              "nonmanifold_edges",
                              "nonmanifold_vertices",
                              "boundary_loops",
                              "components",
                              "oriented",
                              "left_out",
                              "seconds",
                              "warnings"});
  CHECK(info["left_out"].empty());
  CHECK(info["vertices"] == 2 + 19 * 26);
  CHECK(info["triangles"] == 2 * 19 * 26);
  const json converted =
      focal_json("convert " + (scratch / "egg0.landmarks.json") + " " + (scratch / "a.mrk.json"));
  CHECK(keys_of(converted) == Keys{"in", "out", "landmarks", "left_out"});
  CHECK(converted["landmarks"].size() == 4);
  CHECK(focal_cli::read_landmark_file(scratch / "a.mrk.json").landmarks.size() == 4);
}

TEST_CASE("quiet prints nothing, and without it there is something to read") {
  const Run quiet = focal("doctor --quiet");
  CHECK(quiet.status == 0);
  CHECK(quiet.out.empty());
  CHECK(quiet.err.empty());
  CHECK_FALSE(focal("doctor").out.empty());
}

TEST_CASE("what cannot work is answered with 1, a message and a hint") {
  const ScratchFolder scratch;
  write_tiny_set(scratch, 2, 0);
  const std::string set = scratch.path.string(), glb = focal_cli::read_text_file(scratch / "egg0.glb");
  check_fails("train " + (scratch / "nowhere") + " -o x.focal", "no folder");
  check_fails("train " + set + " -o " + (scratch / "nowhere/x.focal"), "no folder");
  check_fails("train " + set + " -o x.focal --split test", "split 'test'");
  check_fails("train " + set + " -o " + (scratch / "one.focal") + " --limit 1", "");
  CHECK_FALSE(std::filesystem::exists(scratch / "one.focal"));
  check_fails("cross-validate " + set, "at least 3");
  check_fails("info " + (scratch / "nowhere.glb"), "nowhere.glb");
  check_fails("info " + scratch.write("cut.glb", glb.substr(0, glb.size() / 2)), "cut.glb");
  check_fails("info " + scratch.write("text.focal", "hello"), "text.focal");
  check_fails("detect " + (scratch / "nowhere.focal") + " " + (scratch / "egg0.glb"), "nowhere.focal");
  check_fails("detect a.focal b.glb -o out.txt", "out.txt");
  check_fails("convert " + (scratch / "egg0.glb") + " x.csv", "egg0.glb");
  check_fails("convert " + (scratch / "nowhere.csv") + " " + (scratch / "x.pp"), "nowhere.csv");
}

#if !defined(FOCAL_SANITIZED)  // whose allocator does not count for us
TEST_CASE("a memory budget: enough, too little, no number") {
  const std::string detect = "detect " + eggs().model() + " " + eggs().mesh() + " --quiet --memory-budget ";
  CHECK(focal(detect + "200MB").status == 0);
  check_fails(detect + "100KB", "the memory budget of 102400 bytes is too small");
  CHECK(focal(detect + "much").status == 2);
}
#endif

TEST_CASE("a mark on a vertex that is not there names mesh and landmark") {
  const ScratchFolder scratch;
  write_tiny_set(scratch, 3, 0);
  scratch.write("egg1.landmarks.json",
                R"({"format":"focal-landmarks","version":1,"landmarks":[{"name":"tail","vertex":99999}]})");
  check_fails("train " + scratch.path.string() + " -o " + (scratch / "x.focal"),
              "mesh 'egg1', landmark 'tail'");
}

TEST_CASE("train: keys, and the model it speaks of") {
  CHECK(keys_of(eggs().trained) == Keys{"model", "set", "preset", "meshes", "landmarks", "joints", "samples",
                                        "tree_nodes", "file_bytes", "seconds", "peak_memory_bytes",
                                        "backend"});
  CHECK(eggs().trained["file_bytes"] == std::filesystem::file_size(eggs().model()));
  const json info = focal_json("info " + eggs().model());
  CHECK(keys_of(info) == Keys{"kind", "file", "file_bytes", "preset", "landmarks", "joints", "shapes",
                              "mean_vertices", "samples", "tree_nodes", "parameters"});
  CHECK(info["joints"].empty());
  CHECK(info["landmarks"] == json({"nose", "horn.L", "horn.R", "tail"}));
  CHECK(info["shapes"] == 4);
  CHECK(info["parameters"]["trees"] == 8);
  CHECK(info["parameters"]["eigenpairs"] == 40);
}

TEST_CASE("detect: keys, and places that lie where they say") {
  const json report = focal_json("detect " + eggs().model() + " " + eggs().mesh());
  CHECK(keys_of(report) == Keys{"mesh", "vertices", "triangles", "warnings", "seconds", "peak_memory_bytes",
                                "backend", "landmarks", "category_fit"});
  CHECK(keys_of(report["seconds"]) == Keys{"load", "repair", "proxy", "spectrum", "descriptors", "geodesics",
                                           "forest", "vote", "constellation", "refine", "total"});
  REQUIRE(report["landmarks"].size() == 4);
  for (const json& landmark : report["landmarks"]) {
    CHECK(keys_of(landmark) == Keys{"name", "status", "confidence", "triangle", "barycentric", "vertex",
                                    "position", "expected_error", "runner_up"});
    if (!landmark["runner_up"].is_null()) {
      CHECK(keys_of(landmark["runner_up"]) ==
            Keys{"confidence", "triangle", "barycentric", "vertex", "position"});
    }
    CHECK(landmark["barycentric"].size() == 3);
    CHECK(landmark["position"].size() == 3);
  }
}

TEST_CASE("rig, and train on rigs, say what they lack") {
  const ScratchFolder scratch;
  check_fails("rig " + eggs().model() + " " + eggs().mesh() + " -o " + (scratch / "a.glb"),
              "knows no skeleton");
  check_fails("train --rigs " + eggs().mesh() + " -o " + (scratch / "a.focal"), "has no skin");
  check_fails("train -o " + (scratch / "a.focal"), "either a SET or --rigs");
}

TEST_CASE("rig by a template: joints where its landmarks say, or a word on what is wrong with it") {
  const ScratchFolder scratch;
  const std::string file = scratch / "template.json";
  const std::string rig =
      "rig " + eggs().model() + " " + eggs().mesh() + " --template " + file + " -o " + (scratch / "a.glb");
  const auto write = [&](const std::string& joints) {
    std::ofstream(file) << R"({"format": "focal-skeleton-template", "version": 1, "joints": [)" << joints
                        << "]}";
  };
  write(
      R"({"name": "body", "between": ["nose", "tail"]}, {"name": "tip", "parent": "body", "surface": ["tail"]})");
  const json report = focal_json(rig);
  REQUIRE(report["joints"].size() == 2);
  CHECK(report["joints"][0]["name"] == "body");
  CHECK(report["joints"][1]["parent"] == "body");
  CHECK(report["weights"]["max_influences"] == 2);
  CHECK(focal_json("info " + (scratch / "a.glb"))["kind"] == "mesh");
  check_fails(rig + " --animations " + eggs().mesh(), "together with a template");
  check_fails(rig + " --rest-pose", "no rest pose");
  write(R"({"name": "body", "between": ["nose", "tial"]})");
  check_fails(rig, "'tial'");
  write(R"({"name": "body", "middle": ["nose", "tail"]})");
  check_fails(rig, "unknown \"middle\"");
  write(R"({"name": 7})");
  check_fails(rig, "no text");
  std::ofstream(file) << "{}";
  check_fails(rig, "format");
  std::ofstream(file) << "[1,";
  check_fails(rig, "the skeleton template: JSON");
}

TEST_CASE(
    "train by a template: the model carries the skeleton, and a slip of the pen is found before the work") {
  const ScratchFolder scratch;
  const std::string file = scratch / "template.json", model = scratch / "a.focal";
  const std::string train =
      "train " + eggs().folder() + " --template " + file + " -o " + model + " --eigenpairs 40 --trees 8";
  const auto write = [&](const std::string& joints) {
    std::ofstream(file) << R"({"format": "focal-skeleton-template", "version": 1, "joints": [)" << joints
                        << "]}";
  };
  write(R"({"name": "body", "between": ["nose", "tial"]})");
  check_fails(train, "'tial'");
  CHECK_FALSE(std::filesystem::exists(model));
  write(
      R"({"name": "body", "between": ["nose", "tail"]}, {"name": "tip", "parent": "body", "surface": ["tail"]})");
  CHECK(focal_json(train)["joints"] == json({"body", "tip"}));
  CHECK(focal_json("info " + model)["joints"] == json({"body", "tip"}));
  const std::string rig = "rig " + model + " " + eggs().mesh() + " -o " + (scratch / "a.glb");
  CHECK(focal_json(rig + " --keep-failed")["joints"][1]["parent"] == "body");
  check_fails(rig + " --animations " + eggs().mesh(), "together with a template");
}

TEST_CASE("segment: a label for each triangle, by the landmarks' names") {
  const ScratchFolder scratch;
  const std::string out = " -o " + (scratch / "parts.glb");
  for (const std::string method : {"auto", "k-means"}) {
    const json report =
        focal_json("segment " + eggs().model() + " " + eggs().mesh() + out + " --method " + method);
    CHECK(keys_of(report) == Keys{"mesh", "output", "parts", "labels"});
    REQUIRE(report["parts"].size() == 4);
    CHECK(report["parts"][0]["name"] == "nose");
    size_t triangles = 0;
    for (const json& part : report["parts"]) triangles += part["triangles"].get<size_t>();
    CHECK(triangles == report["labels"].size());
    CHECK(json::parse(focal_cli::read_text_file(scratch / "parts.labels.json")) == report);
  }
  CHECK(focal_json("info " + (scratch / "parts.glb"))["kind"] == "mesh");
  check_fails("segment " + eggs().model() + " " + eggs().mesh() + out + " --method skeleton",
              "not learned from rigged characters");
}

TEST_CASE("correspond: landmarks by name, and a point for every vertex") {
  const ScratchFolder scratch;
  const json report = focal_json("correspond " + eggs().model() + " " + eggs().mesh() + " " + eggs().mesh() +
                                 " -o " + (scratch / "map.json") + " --dense");
  CHECK(keys_of(report) == Keys{"from", "to", "landmarks", "vertices"});
  CHECK(report["vertices"].size() == 2 + 19 * 26);
  for (const json& pair : report["landmarks"]) CHECK(pair["from"] == pair["to"]);  // the same mesh twice
}

TEST_CASE("batch: one bad file stops nothing, what is there is kept, shards share the work") {
  const ScratchFolder scratch, results;
  std::filesystem::copy_file(eggs().mesh(), scratch / "a.glb");
  std::filesystem::copy_file(eggs().mesh(), scratch / "c.glb");
  focal_cli::write_file_atomically(scratch / "b.glb", "nothing");
  const std::string line =
      "batch " + eggs().model() + " " + scratch.path.string() + " -o " + results.path.string();
  CHECK(focal_json(line + " --shard 1/2")["done"] == 2);  // a and c
  const Run second = focal(line + " --json");
  CHECK(second.status == 1);
  CHECK(second.err.find("1 of 3 meshes failed") != std::string::npos);
  const json again = json::parse(second.out);
  CHECK(keys_of(again) == Keys{"meshes", "done", "kept", "failed", "skipped"});
  CHECK(again["skipped"].empty());
  CHECK(again["kept"] == 2);
  CHECK(again["failed"] == 1);
  CHECK(again["meshes"][1]["status"] == "failed");
  CHECK(focal_json("info " + (results / "c.glb"))["vertices"] == 2 + 19 * 26);
  check_fails(line + " --shard 3/2", "no shard");
}

TEST_CASE("detect writes landmark files of every format, a glTF with landmarks and the votes") {
  const ScratchFolder scratch;
  for (const std::string name : {"a.landmarks.json", "a.mrk.json", "a.fcsv", "a.csv", "a.pp"}) {
    CAPTURE(name);
    const Run run =
        focal("detect " + eggs().model() + " " + eggs().mesh() + " --quiet -o " + (scratch / name));
    CHECK(run.status == 0);
    CHECK(run.out.empty());
    CHECK_FALSE(focal_cli::read_landmark_file(scratch / name).landmarks.empty());
  }
  focal_json("detect " + eggs().model() + " " + eggs().mesh() + " -o " + (scratch / "a.glb") + " --votes " +
             (scratch / "votes.glb"));
  CHECK(focal_json("info " + (scratch / "a.glb"))["vertices"] == 2 + 19 * 26);
  CHECK(focal_json("info " + (scratch / "votes.glb"))["vertices"] == 2 + 19 * 26);
}

TEST_CASE("the same landmarks, to the bit, for one thread and two") {
  json one = focal_json("detect " + eggs().model() + " " + eggs().mesh() + " --threads 1");
  json two = focal_json("detect " + eggs().model() + " " + eggs().mesh() + " --threads 2");
  CHECK(one["landmarks"] == two["landmarks"]);
}

TEST_CASE("eval: keys, subset and limit") {
  const json report = focal_json("eval " + eggs().model() + " " + eggs().folder());
  Keys expected = summary_keys;
  expected.insert(
      {"set", "model", "preset", "descriptor", "distance", "split", "quality", "meshes", "landmarks"});
  CHECK(keys_of(report) == expected);
  check_summary(report);
  REQUIRE(report["meshes"].size() == 2);
  for (const json& mesh : report["meshes"]) {
    CHECK(keys_of(mesh) == Keys{"name", "vertices", "seconds", "category_fit", "errors_edges",
                                "errors_root_area", "confidences", "said_absent", "swapped", "flipped"});
    CHECK(keys_of(mesh["confidences"]) == keys_of(mesh["errors_edges"]));
    CHECK(mesh["category_fit"].get<double>() >= 0);
    CHECK(mesh["category_fit"].get<double>() <= 1);
    CHECK(keys_of(mesh["errors_edges"]) == Keys{"nose", "horn.L", "horn.R", "tail"});
  }
  REQUIRE(report["landmarks"].size() == 4);
  CHECK(keys_of(report["landmarks"][0]) == Keys{"name", "marks", "mean_edges", "median_edges", "p95_edges",
                                                "max_edges", "within_4_edges", "over_10_edges"});
  CHECK(report["flipped_meshes"].is_number());
  CHECK(report["absent"]["recall"].is_null());
  const json part =
      focal_json("eval " + eggs().model() + " " + eggs().folder() + " --subset nose,tail --limit 1");
  REQUIRE(part["meshes"].size() == 1);
  CHECK(keys_of(part["meshes"][0]["errors_edges"]) == Keys{"nose", "tail"});
  CHECK(part["swap_rate"].is_null());
  CHECK(part["meshes"][0]["flipped"].is_null());
  check_fails("eval " + eggs().model() + " " + eggs().folder() + " --subset nose,wing", "'wing'");
  CHECK(focal("eval " + eggs().model() + " " + eggs().folder()).out.find("egg5") != std::string::npos);
}

TEST_CASE("cross-validate: every mesh once, no mesh in both") {
  const json report =
      focal_json("cross-validate " + eggs().folder() + " --split all --folds 3 --eigenpairs 40 --trees 4");
  Keys expected = summary_keys;
  expected.insert({"set", "preset", "descriptor", "distance", "folds", "meshes", "landmarks"});
  CHECK(keys_of(report) == expected);
  check_summary(report);
  REQUIRE(report["meshes"].size() == 6);
  for (size_t i = 0; i < 6; ++i) {
    CHECK(report["meshes"][i]["name"] == "egg" + std::to_string(i));
    CHECK(report["meshes"][i]["fold"] == i / 2);
  }
  CHECK(report["landmarks"].size() == 4);
}

// --foreground: otherwise timeout signals the command twice, and a second Ctrl-C ends it at once.
TEST_CASE("Ctrl-C ends training with 1, a word, and no model") {
  const ScratchFolder scratch;
  const std::string model = scratch / "never.focal";
  const Run run = focal("train " + eggs().folder() + " -o " + model + " --trees 10000",
                        "timeout --foreground --preserve-status -s INT 1");
  CHECK(run.status == 1);
  CHECK(run.err.find("cancelled") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(model));
}
