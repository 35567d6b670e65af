// What eval and cross-validate say: one mesh judged, and all of them as JSON and as tables.
#include "report.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "command_error.h"
#include "text_table.h"

namespace focal_cli {
namespace {

std::vector<Guess> guesses_of(const focal_detection* detection, const std::set<std::string>& counted) {
  std::vector<Guess> guesses;
  auto landmark = initialised(focal_landmark_init);
  for (uint32_t i = 0; i < focal_detection_landmark_count(detection); ++i) {
    check(focal_detection_get_landmark(detection, i, &landmark));
    if (!counted.contains(landmark.name)) continue;
    Guess guess{landmark.name, {}, landmark.confidence, landmark.status == FOCAL_LANDMARK_ABSENT};
    if (landmark.point.triangle != FOCAL_NO_TRIANGLE) {
      guess.position = {landmark.position[0], landmark.position[1], landmark.position[2]};
    }
    guesses.push_back(std::move(guess));
  }
  return guesses;
}

Json bins_json(const std::vector<CalibrationBin>& bins) {
  Json list = Json::array();
  for (const CalibrationBin& bin : bins) {
    list.push_back({{"from", bin.from},
                    {"to", bin.to},
                    {"count", bin.count},
                    {"confidence", bin.confidence},
                    {"accuracy", bin.accuracy}});
  }
  return list;
}

std::vector<std::string> row_of(const MeshOutcome& mesh) {
  std::vector<double> errors;
  const Outcome* worst = nullptr;
  for (const Outcome& outcome : mesh.outcomes) {
    if (!outcome.marked) continue;
    errors.push_back(outcome.error_edges);
    if (!worst || outcome.error_edges > worst->error_edges) worst = &outcome;
  }
  const auto flipped = is_flipped(mesh);
  return {mesh.name,
          std::to_string(mesh.vertices),
          fixed_text(mesh.seconds, 2),
          fixed_text(mean(errors), 2),
          fixed_text(quantile(errors, 0.5), 2),
          fixed_text(worst ? worst->error_edges : NAN, 2),
          worst ? worst->name : "-",
          percent_text(swapped_share(mesh), 0),
          !flipped   ? "-"
          : *flipped ? "yes"
                     : "no"};
}

}  // namespace

std::vector<std::string> landmark_names_of(const focal_model* model) {
  auto info = initialised(focal_model_info_init);
  check(focal_model_get_info(model, &info));
  std::vector<std::string> names;
  for (uint32_t i = 0; i < info.landmark_count; ++i) names.emplace_back(focal_model_landmark_name(model, i));
  return names;
}

MeshOutcome evaluate_mesh(const focal_model* model, const MarkedMesh& mesh, const SetFolder& set,
                          const std::set<std::string>& counted, const focal_detect_params& params,
                          focal_task* task) {
  const auto start = std::chrono::steady_clock::now();
  const auto detection = owned<Detection>(focal_model_detect, model, mesh.mesh.get(), &params, task);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  std::map<std::string, Position> marks;
  for (const auto& [name, point] : mesh.marks) marks[name] = position_of(mesh.mesh.get(), point);
  const focal_mesh_info info = info_of(mesh.mesh.get());
  const MeshScale scale{info.mean_edge_length, std::sqrt(info.surface_area)};
  return {mesh.name, info.vertex_count, mesh.load_seconds + elapsed.count(),
          judge(guesses_of(detection.get(), counted), marks, set.mirror, scale)};
}

std::set<std::string> counted_landmarks(const SetFolder& set, const std::vector<std::string>& subset) {
  const std::set<std::string> known(set.landmark_names.begin(), set.landmark_names.end());
  for (const std::string& name : subset) {
    if (!known.contains(name)) {
      throw CommandError("set '" + set.name + "' has no landmark '" + name + "'",
                         "--subset takes names of landmark_names in set.json, with commas between");
    }
  }
  return subset.empty() ? known : std::set<std::string>(subset.begin(), subset.end());
}

Json mesh_json(const MeshOutcome& mesh) {
  Json edges = Json::object(), root_area = Json::object();
  for (const Outcome& outcome : mesh.outcomes) {
    if (!outcome.marked) continue;
    edges[outcome.name] = outcome.error_edges;
    root_area[outcome.name] = outcome.error_root_area;
  }
  const auto flipped = is_flipped(mesh);
  return {{"name", mesh.name},
          {"vertices", mesh.vertices},
          {"seconds", mesh.seconds},
          {"errors_edges", edges},
          {"errors_root_area", root_area},
          {"swapped", swapped_share(mesh)},
          {"flipped", flipped ? Json(*flipped) : Json(nullptr)}};
}

void add_summary(Json& document, const Summary& summary) {
  document["mean_edges"] = summary.mean_edges;
  document["median_edges"] = summary.median_edges;
  document["p95_edges"] = summary.p95_edges;
  document["mean_root_area_x100"] = summary.mean_root_area_x100;
  document["over_10_edges"] = summary.over_10_edges;
  document["swap_rate"] = summary.swap_rate;
  document["flipped_meshes"] = summary.flipped_meshes ? Json(*summary.flipped_meshes) : Json(nullptr);
  document["absent"] = {{"precision", summary.absent_precision}, {"recall", summary.absent_recall}};
  document["calibration"] = {{"expected_calibration_error", summary.calibration.expected_error},
                             {"auroc", summary.calibration.auroc},
                             {"bins", bins_json(summary.calibration.bins)}};
  document["seconds_median"] = summary.seconds_median;
}

void print_meshes(std::ostream& out, std::span<const MeshOutcome> meshes) {
  std::vector<std::vector<std::string>> rows = {
      {"mesh", "vertices", "seconds", "mean", "median", "worst", "where", "swapped", "flipped"}};
  for (const MeshOutcome& mesh : meshes) rows.push_back(row_of(mesh));
  print_table(out, rows);
}

void print_landmarks(std::ostream& out, std::span<const MeshOutcome> meshes) {
  std::vector<std::vector<std::string>> rows = {{"landmark", "marks", "mean", "median", "worst", "over 10"}};
  for (const LandmarkSummary& row : summarise_landmarks(meshes)) {
    rows.push_back({row.name, std::to_string(row.marks), fixed_text(row.mean_edges, 2),
                    fixed_text(row.median_edges, 2), fixed_text(row.max_edges, 2),
                    percent_text(row.over_10_edges)});
  }
  print_table(out, rows);
}

void print_summary(std::ostream& out, const Summary& summary) {
  out << "\nErrors in mean edge lengths of the mesh, over " << summary.marks << " marks\n";
  print_facts(out,
              {{"  mean", fixed_text(summary.mean_edges, 2)},
               {"  median", fixed_text(summary.median_edges, 2)},
               {"  95th percentile", fixed_text(summary.p95_edges, 2)},
               {"  over 10", percent_text(summary.over_10_edges)},
               {"  mean in % of sqrt(area)", fixed_text(summary.mean_root_area_x100, 2)},
               {"Swapped left and right", percent_text(summary.swap_rate)},
               {"Flipped meshes", summary.flipped_meshes ? std::to_string(*summary.flipped_meshes) : "-"},
               {"Absent, precision", percent_text(summary.absent_precision)},
               {"Absent, recall", percent_text(summary.absent_recall)},
               {"Confidence, calibration error", fixed_text(summary.calibration.expected_error, 3)},
               {"Confidence, AUROC", fixed_text(summary.calibration.auroc, 3)},
               {"Seconds a mesh, median", fixed_text(summary.seconds_median, 2)}});
}

}  // namespace focal_cli
