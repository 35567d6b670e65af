// Landmark formats: round trips, 3D Slicer's axes, and files that are not what they say.
#include "landmark_files.h"

#include <doctest/doctest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "command_error.h"
#include "files.h"
#include "scratch_folder.h"

using namespace focal_cli;

namespace {

// Awkward on purpose: quotes, commas, markup, another script, numbers that only shortest round-trip text
// keeps.
LandmarkFile awkward_file() {
  LandmarkFile file{"a mesh.glb", {}};
  const char* names[] = {"hand.L", "a, \"b\" <c> & d", "\xE9\xBC\xBB", "tail"};
  for (size_t i = 0; i < 4; ++i) {
    Landmark mark;
    mark.name = names[i];
    mark.position = Position{0.1 + static_cast<double>(i), -1.0 / 3, 1e-17 * static_cast<double>(i + 1)};
    mark.status = i == 3 ? "absent" : "found";
    mark.confidence = 0.25 * static_cast<double>(i);
    file.landmarks.push_back(mark);
  }
  file.landmarks[0].vertex = 4294967294u;
  file.landmarks[1].surface = SurfacePlace{7, {0.5, 0.25, 0.25}};
  return file;
}

void check_same_places(const LandmarkFile& a, const LandmarkFile& b, size_t count) {
  REQUIRE(b.landmarks.size() == count);
  for (size_t i = 0; i < count; ++i) {
    CHECK(a.landmarks[i].name == b.landmarks[i].name);
    REQUIRE(b.landmarks[i].position.has_value());
    CHECK(*a.landmarks[i].position == *b.landmarks[i].position);  // exactly: every digit counts
  }
}

Position only_position(LandmarkFormat format, const std::string& text) {
  const LandmarkFile file = parse_landmarks(format, text);
  REQUIRE(file.landmarks.size() == 1);
  return file.landmarks[0].position.value();
}

}  // namespace

TEST_CASE("our own JSON keeps everything") {
  const LandmarkFile file = awkward_file();
  const LandmarkFile back = parse_landmarks(LandmarkFormat::own_json, format_own_json(file));
  check_same_places(file, back, 4);
  CHECK(back.mesh == "a mesh.glb");
  CHECK(back.landmarks[0].vertex == 4294967294u);
  CHECK(back.landmarks[1].surface->triangle == 7);
  CHECK(back.landmarks[1].surface->barycentric == Position{0.5, 0.25, 0.25});
  CHECK(back.landmarks[2].confidence == 0.5);
  CHECK(back.landmarks[3].absent());
}

TEST_CASE("the other formats keep names and positions exactly, and leave absent landmarks out") {
  const LandmarkFile file = awkward_file();
  for (const auto format : {LandmarkFormat::slicer_json, LandmarkFormat::slicer_fcsv, LandmarkFormat::csv,
                            LandmarkFormat::meshlab}) {
    CAPTURE(static_cast<int>(format));
    check_same_places(file, parse_landmarks(format, format_landmarks(format, file)), 3);
  }
}

TEST_CASE("Slicer's RAS is turned into the mesh's LPS, LPS is kept") {
  const auto json = [](const std::string& system) {
    return R"({"markups":[{"coordinateSystem":)" + system +
           R"(,"controlPoints":[{"label":"a","position":[1,2,3]},)"
           R"({"label":"b","positionStatus":"undefined"}]}]})";
  };
  CHECK(only_position(LandmarkFormat::slicer_json, json("\"LPS\"")) == Position{1, 2, 3});
  CHECK(only_position(LandmarkFormat::slicer_json, json("\"RAS\"")) == Position{-1, -2, 3});
  CHECK(only_position(LandmarkFormat::slicer_json, json("0")) == Position{-1, -2, 3});
  CHECK_THROWS_AS(parse_landmarks(LandmarkFormat::slicer_json, json("\"IJK\"")), CommandError);
  const std::string row = "F_1,1,2,3,0,0,0,1,1,1,0,a,,\n";
  const auto fcsv = [&](const std::string& head) {
    return only_position(LandmarkFormat::slicer_fcsv,
                         "# Markups fiducial file version = 4.11\r\n" + head + row);
  };
  CHECK(fcsv("# CoordinateSystem = LPS\n") == Position{1, 2, 3});
  CHECK(fcsv("# CoordinateSystem = 0\n") == Position{-1, -2, 3});
  CHECK(fcsv("") == Position{-1, -2, 3});
  CHECK(only_position(LandmarkFormat::slicer_fcsv,
                      "# CoordinateSystem = LPS\n# columns = label,x,y,z\nnose,4,5,6\n") ==
        Position{4, 5, 6});
}

TEST_CASE("what is written for Slicer says LPS") {
  const auto document = nlohmann::json::parse(format_slicer_json(awkward_file()));
  CHECK(document["markups"][0]["coordinateSystem"] == "LPS");
  CHECK(document["markups"][0]["type"] == "Fiducial");
  CHECK(format_slicer_fcsv(awkward_file()).find("# CoordinateSystem = LPS\n") != std::string::npos);
}

TEST_CASE("CSV columns are found by name, in any order, with a byte-order mark and Windows line ends") {
  const std::string text = "\xEF\xBB\xBFz, name ,colour,x,y\r\n3,\"a \"\"b\"\", c\",red,1,2\r\n\r\n";
  const LandmarkFile file = parse_landmarks(LandmarkFormat::csv, text);
  REQUIRE(file.landmarks.size() == 1);
  CHECK(file.landmarks[0].name == "a \"b\", c");
  CHECK(file.landmarks[0].position == Position{1, 2, 3});
}

TEST_CASE("tables of every spreadsheet: separators, decimal commas, capitals, a label for a name") {
  const auto place = [](const std::string& text) { return only_position(LandmarkFormat::csv, text); };
  for (const std::string separator : {",", ";", "\t"})
    for (const std::string name : {"name", "Name", "label", "LABEL"})
      for (const std::string quote : {"", "\""}) {
        const auto line = [&](const std::array<std::string, 4>& cells) {
          std::string text;
          for (const std::string& cell : cells)
            text += (text.empty() ? "" : separator) + quote + cell + quote;
          return text + "\r\n";
        };
        CAPTURE(separator);
        CHECK(place(line({name, "X", "y", "Z"}) + line({"nose", "0.0123", "-1.5", "2e1"})) ==
              Position{0.0123, -1.5, 20});
        if (separator == "," && quote.empty()) continue;
        CHECK(place(line({name, "X", "y", "Z"}) + line({"nose", "0,0123", "-1,5", "0,125"})) ==
              Position{0.0123, -1.5, 0.125});
      }
  CHECK(place("name;x;y;z\na, b;1,234;1,5;2\n") == Position{1.234, 1.5, 2});
  for (const char* doubtful :
       {"name,x,y,z\na,\"1,234\",2,3\n", "name\tx\ty\tz\na\t1,234\t2\t3\n", "name;x;y;z\na;1,2,3;2;3\n",
        "name;x;y;z\na;1.000,5;2;3\n", "name;name;x;y;z\na;b;1;2;3\n", "\tx\ty\tz\na\t1\t2\t3\n",
        "name\tx\ty\tz\n\t1\t2\t3\n"})
    CHECK_THROWS_AS(parse_landmarks(LandmarkFormat::csv, doubtful), CommandError);
}

TEST_CASE("Slicer's points that are not placed are absent") {
  const std::string head = "# Markups fiducial file version = 5.2\n# CoordinateSystem = LPS\n";
  const std::string columns = "# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n";
  const auto row = [](const std::string& label, const std::string& status) {
    return "1,1,2,3,0,0,0,1,1,1,0," + label + ",,," + status + ",0\n";
  };
  const std::string rows =
      row("undefined", "0") + row("preview", "1") + row("placed", "2") + row("missing", "3");
  for (const std::string& text : {head + columns + rows, head + rows}) {
    const LandmarkFile file = parse_landmarks(LandmarkFormat::slicer_fcsv, text);
    REQUIRE(file.landmarks.size() == 1);
    CHECK(file.landmarks[0].name == "placed");
  }
}

TEST_CASE("MeshLab's points that were not picked are absent") {
  const std::string text =
      "<!DOCTYPE PickedPoints>\n<PickedPoints>\n <point active='1' name='a &lt;&amp;&gt;' x=\"1\" y=\"2\" "
      "z='-3e0'/>"
      "\n <point x=\"0\" y=\"0\" z=\"0\" name=\"b\" active=\"0\"/>\n</PickedPoints>";
  const LandmarkFile file = parse_landmarks(LandmarkFormat::meshlab, text);
  REQUIRE(file.landmarks.size() == 1);
  CHECK(file.landmarks[0].name == "a <&>");
  CHECK(file.landmarks[0].position == Position{1, 2, -3});
}

TEST_CASE("the ending chooses the format, whatever its case") {
  CHECK(landmark_format_of("a.b/C.MRK.JSON") == LandmarkFormat::slicer_json);
  CHECK(landmark_format_of("x.landmarks.json") == LandmarkFormat::own_json);
  CHECK(landmark_format_of("x.fcsv") == LandmarkFormat::slicer_fcsv);
  CHECK(landmark_format_of("x.Csv") == LandmarkFormat::csv);
  CHECK(landmark_format_of("x.pp") == LandmarkFormat::meshlab);
  CHECK_THROWS_AS(landmark_format_of("x.txt"), CommandError);
}

TEST_CASE("damaged and foreign files are refused by name, with a hint") {
  const ScratchFolder scratch;
  const std::string head = R"({"format":"focal-landmarks","version":1,"mesh":"m","landmarks":)";
  const std::pair<std::string, std::string> files[] = {
      {"cut.json", format_own_json(awkward_file()).substr(0, 150)},
      {"other.json", "{\"a\":1}"},
      {"list.json", "[1]"},
      {"newer.json", R"({"format":"focal-landmarks","version":2,"landmarks":[]})"},
      {"negative.json", head + R"([{"name":"a","vertex":-1}]})"},
      {"fraction.json", head + R"([{"name":"a","vertex":1.5}]})"},
      {"large.json", head + R"([{"name":"a","vertex":4294967296}]})"},
      {"two.json", head + R"([{"name":"a","position":[1,2]}]})"},
      {"text.json", head + R"([{"name":"a","position":[1,2,"x"]}]})"},
      {"nowhere.json", head + R"([{"name":"a"}]})"},
      {"twice.json", head + R"([{"name":"a","vertex":1},{"name":"a","vertex":2}]})"},
      {"unnamed.json", head + R"([{"name":"","vertex":1}]})"},
      {"typed.json", head + R"([{"name":3,"vertex":1}]})"},
      {"a.mrk.json", R"({"markups":[{"controlPoints":[{"label":"a","position":[1,2]}]}]})"},
      {"deep.json", head + std::string(100'000, '[')},
      {"deep.mrk.json", R"({"markups":)" + std::string(100'000, '[') + std::string(100'000, ']') + "}"},
      {"empty.csv", ""},
      {"headless.csv", "a,1,2,3\n"},
      {"comma.csv", "name,x,y,z\na,1;5,2,3\n"},
      {"nan.csv", "name,x,y,z\na,nan,2,3\n"},
      {"short.csv", "name,x,y,z\na,1,2\n"},
      {"short.fcsv", "F_1,1,2,3\n"},
      {"open.pp", "<PickedPoints><point x=\"1\" y=\"2\" z=\"3"},
      {"none.pp", "hello"}};
  for (const auto& file : files) {
    CAPTURE(file.first);
    const std::string path = scratch.write(file.first, file.second);
    try {
      read_landmark_file(path);
      FAIL("read without complaint");
    } catch (const CommandError& error) {
      CHECK(std::string(error.what()).find(file.first) != std::string::npos);
    }
  }
}

TEST_CASE("a format that holds only positions refuses a landmark without one") {
  LandmarkFile file = awkward_file();
  file.landmarks[0].position.reset();
  CHECK_THROWS_AS(format_csv(file), CommandError);
  CHECK_NOTHROW(format_own_json(file));
}
