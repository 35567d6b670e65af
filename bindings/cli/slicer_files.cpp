// 3D Slicer's landmark files: .mrk.json (markups schema 1.0) and the older .fcsv.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "command_error.h"
#include "json_text.h"
#include "landmark_files.h"
#include "landmark_text.h"

namespace focal_cli {
namespace {

using Json = nlohmann::ordered_json;

// Sign of x and y that brings a file's coordinates to LPS. Old files number the systems: 0 RAS, 1 LPS, 2 IJK.
double to_lps(std::string_view system) {
  if (system == "LPS" || system == "1") return 1;
  if (system == "RAS" || system == "0") return -1;
  throw CommandError("coordinate system '" + std::string(system) + "' is not one of RAS and LPS",
                     "save the points from 3D Slicer in RAS or LPS");
}

Position turned(const Position& p, double sign) { return {sign * p[0], sign * p[1], p[2]}; }

Json control_point_of(const Landmark& mark, size_t number) {
  return {{"id", std::to_string(number)},
          {"label", mark.name},
          {"description", mark.status},
          {"associatedNodeID", ""},
          {"position", position_of(mark)},
          {"selected", true},
          {"locked", false},
          {"visibility", true},
          {"positionStatus", "defined"}};
}

std::string_view after(std::string_view line, std::string_view key) {
  const size_t at = line.find(key);
  if (at == std::string_view::npos) return {};
  return trimmed(line.substr(line.find('=', at) + 1));
}

struct FcsvColumns {
  size_t x = 1, y = 2, z = 3, label = 11, status = 14;
};

// Slicer 5 writes a status behind the columns that its columns line names: 0 undefined, 1 preview, 2 defined, 3 missing.
bool is_placed(const std::vector<std::string>& cells, const FcsvColumns& columns) {
  if (cells.size() <= columns.status) return true;
  const std::string_view status = trimmed(cells[columns.status]);
  return status.empty() || status == "2";
}

FcsvColumns columns_of(std::string_view list) {
  const std::vector<std::string> names = split_csv_line(list);
  const auto find = [&](std::string_view name) {
    for (size_t i = 0; i < names.size(); ++i) {
      if (trimmed(names[i]) == name) return i;
    }
    throw CommandError("the columns line has no column '" + std::string(name) + "'",
                       "save it again in Slicer");
  };
  return {find("x"), find("y"), find("z"), find("label"), names.size()};
}

}  // namespace

LandmarkFile parse_slicer_json(std::string_view text) {
  const Json document = parse_json<Json>(text);
  LandmarkFile file;
  for (const Json& list : document.at("markups")) {
    const Json system = list.value("coordinateSystem", Json("LPS"));
    const double sign = to_lps(system.is_string() ? system.get<std::string>() : system.dump());
    for (const Json& point : list.value("controlPoints", Json::array())) {
      if (point.value("positionStatus", "defined") != "defined") continue;  // not placed: absent on this mesh
      Landmark mark;
      mark.name = point.at("label").get<std::string>();
      mark.position = turned(point.at("position").get<Position>(), sign);
      file.landmarks.push_back(std::move(mark));
    }
  }
  return file;
}

std::string format_slicer_json(const LandmarkFile& file) {
  Json points = Json::array();
  for (const Landmark& mark : file.landmarks) {
    if (!mark.absent()) points.push_back(control_point_of(mark, points.size() + 1));
  }
  const Json list = {
      {"type", "Fiducial"},     {"coordinateSystem", "LPS"},           {"coordinateUnits", "mm"},
      {"locked", false},        {"fixedNumberOfControlPoints", false}, {"labelFormat", "%N-%d"},
      {"controlPoints", points}};
  const Json document = {{"@schema",
                          "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/"
                          "Resources/Schema/markups-schema-v1.0.3.json#"},
                         {"markups", Json::array({list})}};
  return document.dump(1) + "\n";
}

LandmarkFile parse_slicer_fcsv(std::string_view text) {
  LandmarkFile file;
  FcsvColumns columns;
  double sign = -1;  // files without the line are older than LPS
  for (std::string_view line : lines_of(text)) {
    if (line.starts_with('#')) {
      if (const auto system = after(line, "CoordinateSystem"); !system.empty()) sign = to_lps(system);
      if (const auto list = after(line, "columns"); !list.empty()) columns = columns_of(list);
      continue;
    }
    const std::vector<std::string> cells = split_csv_line(line);
    if (cells.size() <= std::max({columns.x, columns.y, columns.z, columns.label})) {
      throw CommandError("line '" + std::string(line) + "' has too few columns", "save it again in Slicer");
    }
    if (!is_placed(cells, columns)) continue;
    Landmark mark;
    mark.name = cells[columns.label];
    mark.position =
        turned({number_of(cells[columns.x]), number_of(cells[columns.y]), number_of(cells[columns.z])}, sign);
    file.landmarks.push_back(std::move(mark));
  }
  return file;
}

std::string format_slicer_fcsv(const LandmarkFile& file) {
  std::string text =
      "# Markups fiducial file version = 4.11\n# CoordinateSystem = LPS\n"
      "# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n";
  size_t number = 0;
  for (const Landmark& mark : file.landmarks) {
    if (mark.absent()) continue;
    const Position p = position_of(mark);
    text += std::to_string(++number) + "," + text_of(p[0]) + "," + text_of(p[1]) + "," + text_of(p[2]) +
            ",0,0,0,1,1,1,0," + csv_cell(mark.name) + "," + csv_cell(mark.status) + ",\n";
  }
  return text;
}

}  // namespace focal_cli
