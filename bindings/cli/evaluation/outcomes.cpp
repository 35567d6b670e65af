// What eval and cross-validate say: one mesh judged, and all of them as JSON and as tables.
#include "evaluation/outcomes.h"

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
                     : "no",
          percent_text(mesh.category_fit, 0)};
}

std::string sure_text(const Calibration& calibration) {
  return percent_text(calibration.sure_right) + " of " + std::to_string(calibration.sure_count);
}

}  // namespace

std::vector<std::string> landmark_names_of(const focal_model* model) {
  auto info = initialised(focal_model_info_init);
  check(focal_model_get_info(model, &info));
  std::vector<std::string> names;
  for (uint32_t i = 0; i < info.landmark_count; ++i) names.emplace_back(focal_model_landmark_name(model, i));
  return names;
}

TimedDetection detect_on(const focal_model* model, const MarkedMesh& mesh, const focal_detect_params& params,
                         focal_task* task) {
  const auto start = std::chrono::steady_clock::now();
  auto detection = owned<Detection>(focal_model_detect, model, mesh.mesh.get(), &params, task);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  return {std::move(detection), elapsed.count()};
}

MeshOutcome outcome_of(const TimedDetection& found, const MarkedMesh& mesh, const SetFolder& set,
                       const std::set<std::string>& counted) {
  std::map<std::string, Position> marks;
  for (const auto& [name, point] : mesh.marks) marks[name] = position_of(mesh.mesh.get(), point);
  const focal_mesh_info info = info_of(mesh.mesh.get());
  const MeshScale scale{info.mean_edge_length, std::sqrt(info.surface_area)};
  auto detected = initialised(focal_detection_info_init);
  check(focal_detection_get_info(found.detection.get(), &detected));
  return {mesh.name, info.vertex_count, mesh.load_seconds + found.seconds,
          judge(guesses_of(found.detection.get(), counted), marks, set.mirror, scale), detected.category_fit};
}

MeshOutcome evaluate_mesh(const focal_model* model, const MarkedMesh& mesh, const SetFolder& set,
                          const std::set<std::string>& counted, const focal_detect_params& params,
                          focal_task* task) {
  return outcome_of(detect_on(model, mesh, params, task), mesh, set, counted);
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
  Json edges = Json::object(), root_area = Json::object(), confidences = Json::object(),
       absent = Json::array();
  for (const Outcome& outcome : mesh.outcomes) {
    confidences[outcome.name] = outcome.confidence;
    if (outcome.said_absent) absent.push_back(outcome.name);
    if (!outcome.marked) continue;
    edges[outcome.name] = outcome.error_edges;
    root_area[outcome.name] = outcome.error_root_area;
  }
  const auto flipped = is_flipped(mesh);
  return {{"name", mesh.name},
          {"vertices", mesh.vertices},
          {"seconds", mesh.seconds},
          {"category_fit", mesh.category_fit},
          {"errors_edges", edges},
          {"errors_root_area", root_area},
          {"confidences", confidences},
          {"said_absent", absent},
          {"swapped", swapped_share(mesh)},
          {"flipped", flipped ? Json(*flipped) : Json(nullptr)}};
}

Json landmarks_json(std::span<const MeshOutcome> meshes) {
  Json list = Json::array();
  for (const LandmarkSummary& row : summarise_landmarks(meshes)) {
    list.push_back({{"name", row.name},
                    {"marks", row.marks},
                    {"mean_edges", row.mean_edges},
                    {"median_edges", row.median_edges},
                    {"p95_edges", row.p95_edges},
                    {"max_edges", row.max_edges},
                    {"within_4_edges", row.within_4_edges},
                    {"over_10_edges", row.over_10_edges}});
  }
  return list;
}

void add_summary(Json& document, const Summary& summary) {
  document["marks"] = summary.marks;
  document["mean_edges"] = summary.mean_edges;
  document["median_edges"] = summary.median_edges;
  document["p95_edges"] = summary.p95_edges;
  document["mean_root_area_x100"] = summary.mean_root_area_x100;
  document["within_4_edges"] = summary.within_4_edges;
  document["over_10_edges"] = summary.over_10_edges;
  document["swap_rate"] = summary.swap_rate;
  document["flipped_meshes"] = summary.flipped_meshes ? Json(*summary.flipped_meshes) : Json(nullptr);
  document["absent"] = {{"precision", summary.absent_precision}, {"recall", summary.absent_recall}};
  const Calibration& calibration = summary.calibration;
  document["calibration"] = {{"expected_calibration_error", calibration.expected_error},
                             {"auroc", calibration.auroc},
                             {"sure_count", calibration.sure_count},
                             {"sure_within_4_edges", calibration.sure_right},
                             {"bins", bins_json(calibration.bins)}};
  document["category_fit_median"] = summary.category_fit_median;
  document["seconds_median"] = summary.seconds_median;
}

namespace {

void print_meshes(std::ostream& out, std::span<const MeshOutcome> meshes) {
  std::vector<std::vector<std::string>> rows = {
      {"mesh", "vertices", "seconds", "mean", "median", "worst", "where", "swapped", "flipped", "fit"}};
  for (const MeshOutcome& mesh : meshes) rows.push_back(row_of(mesh));
  print_table(out, rows);
}

void print_landmarks(std::ostream& out, std::span<const MeshOutcome> meshes) {
  std::vector<std::vector<std::string>> rows = {
      {"landmark", "marks", "mean", "median", "95 %", "worst", "within 4", "over 10"}};
  for (const LandmarkSummary& row : summarise_landmarks(meshes)) {
    rows.push_back({row.name, std::to_string(row.marks), fixed_text(row.mean_edges, 2),
                    fixed_text(row.median_edges, 2), fixed_text(row.p95_edges, 2),
                    fixed_text(row.max_edges, 2), percent_text(row.within_4_edges),
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
               {"  within 4", percent_text(summary.within_4_edges)},
               {"  over 10", percent_text(summary.over_10_edges)},
               {"  mean in % of sqrt(area)", fixed_text(summary.mean_root_area_x100, 2)},
               {"Swapped left and right", percent_text(summary.swap_rate)},
               {"Flipped meshes", summary.flipped_meshes ? std::to_string(*summary.flipped_meshes) : "-"},
               {"Absent, precision", percent_text(summary.absent_precision)},
               {"Absent, recall", percent_text(summary.absent_recall)},
               {"Confidence, calibration error", fixed_text(summary.calibration.expected_error, 3)},
               {"Confidence, AUROC", fixed_text(summary.calibration.auroc, 3)},
               {"Confidence 0.9 or more, within 4", sure_text(summary.calibration)},
               {"Category fit, median", percent_text(summary.category_fit_median, 0)},
               {"Seconds a mesh, median", fixed_text(summary.seconds_median, 2)}});
}

}  // namespace

void print_outcomes(std::ostream& out, std::span<const MeshOutcome> meshes, const Summary& summary) {
  print_landmarks(out, meshes);
  out << "\n";
  print_meshes(out, meshes);
  print_summary(out, summary);
}

}  // namespace focal_cli
