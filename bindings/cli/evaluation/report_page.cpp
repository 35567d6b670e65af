// focal eval --report: one HTML page that holds all it needs. See report_page.h.
#include "evaluation/report_page.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "landmark_text.h"
#include "paths.h"
#include "report_files.h"
#include "shown_mesh.h"

namespace focal_cli {
namespace {

Json found_json(const focal_landmark& landmark, double mean_edge) {
  const bool placed = landmark.point.triangle != FOCAL_NO_TRIANGLE;
  return {{"status", status_name(landmark.status)},
          {"confidence", landmark.confidence},
          {"expected_edges", mean_edge > 0 ? Json(landmark.expected_error / mean_edge) : Json()},
          {"position", placed ? triple(landmark.position) : Json()},
          {"second", landmark.has_runner_up ? triple(landmark.runner_up_position) : Json()}};
}

// The worst first: flipped meshes, then by mean error.
double badness(const Json& mesh) {
  if (mesh["flipped"] == true) return INFINITY;
  double sum = 0;
  for (const Json& error : mesh["errors_edges"]) sum += error.is_number() ? error.get<double>() : INFINITY;
  return mesh["errors_edges"].empty() ? -1 : sum / static_cast<double>(mesh["errors_edges"].size());
}

// Text within a script element of HTML must not end it.
std::string script_safe(std::string text) {
  std::string safe;
  for (const char c : text) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return safe;
}

// The template with each {{name}} replaced, once: what is put in is not looked at again.
std::string filled(std::string_view page, const std::map<std::string_view, std::string_view>& parts) {
  std::string out;
  for (size_t at = 0; at < page.size();) {
    const size_t open = page.find("{{", at);
    if (open == page.npos) return out.append(page.substr(at));
    const size_t close = page.find("}}", open);
    out.append(page.substr(at, open - at)).append(parts.at(page.substr(open + 2, close - open - 2)));
    at = close + 2;
  }
  return out;
}

}  // namespace

ReportPage::ReportPage(const std::set<std::string>& counted, size_t meshes)
    : counted_(counted), most_vertices_(shown_vertices_for(meshes, counted.size())) {}

void ReportPage::add(const MarkedMesh& mesh, const TimedDetection& found, const MeshOutcome& outcome) {
  const focal_mesh* handle = mesh.mesh.get();
  const double mean_edge = info_of(handle).mean_edge_length;
  Json entry = {{"marks", Json::object()}, {"found", Json::object()}, {"swapped_names", Json::array()}};
  auto landmark = initialised(focal_landmark_init);
  for (uint32_t i = 0; i < focal_detection_landmark_count(found.detection.get()); ++i) {
    check(focal_detection_get_landmark(found.detection.get(), i, &landmark));
    if (!counted_.contains(landmark.name)) continue;
    entry["found"][landmark.name] = found_json(landmark, mean_edge);
    const auto mark = mesh.marks.find(landmark.name);
    if (mark == mesh.marks.end()) continue;
    float position[3];
    check(focal_mesh_position_of(handle, &mark->second, position));
    entry["marks"][landmark.name] = triple(position);
  }
  for (const Outcome& judged : outcome.outcomes) {
    if (judged.swapped.value_or(false)) entry["swapped_names"].push_back(judged.name);
  }
  const ShownMesh shown = shown_mesh(handle, most_vertices_);
  entry["shown"] = shown_mesh_json(handle, shown, found.detection.get(), counted_);
  meshes_.push_back(std::move(entry));
}

std::string ReportPage::html(Json report) const {
  std::vector<Json> meshes;
  for (size_t i = 0; i < meshes_.size(); ++i) {
    meshes.push_back(report["meshes"][i]);
    meshes.back().update(meshes_[i]);
  }
  std::stable_sort(meshes.begin(), meshes.end(),
                   [](const Json& a, const Json& b) { return badness(a) > badness(b); });
  report["meshes"] = std::move(meshes);
  report["model"] = text_of(path_of(report["model"].get<std::string>()).filename());
  report["version"] = focal_version_string();
  report["up"] = "Y";
  const std::string data = script_safe(report.dump(-1, ' ', false, Json::error_handler_t::replace));
  return filled(report_page_text, {{"style", report_style_text},
                                   {"script", report_script_text},
                                   {"three", report_three_text},
                                   {"data", data}});
}

}  // namespace focal_cli
