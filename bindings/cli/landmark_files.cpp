// Choice of the landmark format by file name, and our own JSON.
#include "landmark_files.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "command_error.h"
#include "files.h"
#include "json_text.h"

namespace focal_cli {
namespace {

using Json = nlohmann::ordered_json;

Json own_json_of(const Landmark& mark) {
  Json out = {{"name", mark.name}};
  if (!mark.status.empty()) out["status"] = mark.status;
  if (mark.confidence) out["confidence"] = *mark.confidence;
  if (mark.surface) {
    out["triangle"] = mark.surface->triangle;
    out["barycentric"] = mark.surface->barycentric;
  }
  if (mark.vertex) out["vertex"] = *mark.vertex;
  if (mark.position) out["position"] = *mark.position;
  return out;
}

uint32_t index_of(const Json& value, const std::string& what) {
  if (!value.is_number_integer() || value < 0 || value > UINT32_MAX) {
    throw CommandError(what + " is not a whole number from 0",
                       "numbers of vertices and triangles start at 0");
  }
  return value.get<uint32_t>();
}

std::array<double, 3> triple_of(const Json& value, const std::string& what) {
  const auto finite = [](const Json& x) { return x.is_number() && std::isfinite(x.get<double>()); };
  if (!value.is_array() || value.size() != 3 || !std::all_of(value.begin(), value.end(), finite)) {
    throw CommandError(what + " is not a list of three numbers", "");
  }
  return value.get<std::array<double, 3>>();
}

Landmark landmark_of(const Json& entry) {
  Landmark mark;
  mark.name = entry.at("name").get<std::string>();
  mark.status = entry.value("status", "");
  const std::string of = " of landmark '" + mark.name + "'";
  if (entry.contains("confidence")) mark.confidence = entry["confidence"].get<double>();
  if (entry.contains("vertex")) mark.vertex = index_of(entry["vertex"], "the vertex" + of);
  if (entry.contains("position")) mark.position = triple_of(entry["position"], "the position" + of);
  if (entry.contains("triangle")) {
    mark.surface = {index_of(entry["triangle"], "the triangle" + of),
                    triple_of(entry.at("barycentric"), "barycentric" + of)};
  }
  if (!mark.vertex && !mark.position && !mark.surface && !mark.absent()) {
    throw CommandError("landmark '" + mark.name + "' has no vertex, no triangle and no position",
                       "give one of them, or remove the landmark if the mesh lacks it");
  }
  return mark;
}

void check_names_differ(const LandmarkFile& file) {
  std::set<std::string> seen;
  for (const Landmark& mark : file.landmarks) {
    if (mark.name.empty()) throw CommandError("a landmark has no name", "name every landmark");
    if (!seen.insert(mark.name).second) {
      throw CommandError("landmark '" + mark.name + "' is there twice", "keep one of the two");
    }
  }
}

}  // namespace

LandmarkFormat landmark_format_of(const std::string& path) {
  if (has_ending(path, ".mrk.json")) return LandmarkFormat::slicer_json;
  if (has_ending(path, ".json")) return LandmarkFormat::own_json;
  if (has_ending(path, ".fcsv")) return LandmarkFormat::slicer_fcsv;
  if (has_ending(path, ".csv")) return LandmarkFormat::csv;
  if (has_ending(path, ".pp")) return LandmarkFormat::meshlab;
  throw CommandError("the ending of '" + path + "' has no suffix of a landmark format",
                     "use .landmarks.json, .mrk.json, .fcsv, .csv or .pp");
}

LandmarkFile parse_own_json(std::string_view text) {
  const Json document = parse_json<Json>(text);
  if (!document.is_object() || document.value("format", "") != "focal-landmarks") {
    throw CommandError("this JSON holds no focal landmarks",
                       "it needs \"format\": \"focal-landmarks\"; 3D Slicer's files end in .mrk.json");
  }
  if (document.value("version", 1) != 1) {
    throw CommandError("the landmark file is of a newer version", "update focal, or save it as version 1");
  }
  LandmarkFile file{document.value("mesh", ""), {}};
  for (const Json& entry : document.at("landmarks")) file.landmarks.push_back(landmark_of(entry));
  return file;
}

std::string format_own_json(const LandmarkFile& file) {
  // One landmark per line: people read, compare and edit such files.
  std::string text =
      "{\n \"format\": \"focal-landmarks\", \"version\": 1, \"mesh\": " + Json(file.mesh).dump() +
      ",\n \"landmarks\": [";
  const char* separator = "\n  ";
  for (const Landmark& mark : file.landmarks) {
    text += separator + own_json_of(mark).dump();
    separator = ",\n  ";
  }
  return text + "\n ]\n}\n";
}

LandmarkFile parse_landmarks(LandmarkFormat format, std::string_view text) {
  static constexpr decltype(&parse_own_json) parsers[] = {parse_own_json, parse_slicer_json,
                                                          parse_slicer_fcsv, parse_csv, parse_meshlab};
  LandmarkFile file = parsers[static_cast<size_t>(format)](text);
  check_names_differ(file);
  return file;
}

std::string format_landmarks(LandmarkFormat format, const LandmarkFile& file) {
  static constexpr decltype(&format_own_json) writers[] = {format_own_json, format_slicer_json,
                                                           format_slicer_fcsv, format_csv, format_meshlab};
  return writers[static_cast<size_t>(format)](file);
}

LandmarkFile read_landmark_file(const std::string& path) {
  const LandmarkFormat format = landmark_format_of(path);
  const std::string text = read_text_file(path);
  try {
    return parse_landmarks(format, text);
  } catch (const CommandError& error) {
    throw CommandError("'" + path + "': " + error.what(), error.hint);
  } catch (const nlohmann::json::exception& error) {
    throw CommandError("'" + path + "' is not a landmark file: " + error.what(),
                       "check that it was saved completely and ends as its format says");
  }
}

void write_landmark_file(const std::string& path, const LandmarkFile& file) {
  write_file_atomically(path, format_landmarks(landmark_format_of(path), file));
}

}  // namespace focal_cli
