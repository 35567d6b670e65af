// focal detect: a model's landmarks on one mesh.
#include <filesystem>
#include <iostream>

#include "files.h"
#include "landmark_files.h"
#include "landmark_text.h"
#include "marked_mesh.h"
#include "models.h"
#include "output.h"
#include "parameters.h"
#include "paths.h"
#include "progress.h"
#include "text_table.h"

namespace focal_cli {
namespace {

struct DetectOptions : CommonOptions, DetectionOptions {
  std::string model, mesh, output, votes;
};

// Null where the detector has no place at all to offer.
void add_place(Json& out, const focal_surface_point& point, uint32_t vertex, const float* position) {
  const bool placed = point.triangle != FOCAL_NO_TRIANGLE;
  out["triangle"] = placed ? Json(point.triangle) : Json();
  out["barycentric"] = placed ? triple(point.barycentric) : Json();
  out["vertex"] = placed ? Json(vertex) : Json();
  out["position"] = placed ? triple(position) : Json();
}

Json landmark_json(const focal_landmark& landmark) {
  Json out = {
      {"name", landmark.name}, {"status", status_name(landmark.status)}, {"confidence", landmark.confidence}};
  add_place(out, landmark.point, landmark.vertex, landmark.position);
  out["expected_error"] = landmark.expected_error;
  out["runner_up"] = nullptr;
  if (landmark.has_runner_up) {
    Json second = {{"confidence", landmark.runner_up_confidence}};
    add_place(second, landmark.runner_up_point, landmark.runner_up_vertex, landmark.runner_up_position);
    out["runner_up"] = std::move(second);
  }
  return out;
}

std::vector<focal_landmark> landmarks_of(const focal_detection* detection) {
  std::vector<focal_landmark> landmarks(focal_detection_landmark_count(detection));
  for (uint32_t i = 0; i < landmarks.size(); ++i) {
    landmarks[i] = initialised(focal_landmark_init);
    check(focal_detection_get_landmark(detection, i, &landmarks[i]));
  }
  return landmarks;
}

Json seconds_json(const focal_detection* detection) {
  auto s = initialised(focal_stage_seconds_init);
  check(focal_detection_get_seconds(detection, &s));
  return {{"load", s.load},
          {"repair", s.repair},
          {"proxy", s.proxy},
          {"spectrum", s.spectrum},
          {"descriptors", s.descriptors},
          {"geodesics", s.geodesics},
          {"forest", s.forest},
          {"vote", s.vote},
          {"constellation", s.constellation},
          {"refine", s.refine},
          {"total", s.total}};
}

Json detection_json(const focal_detection* detection, const std::string& mesh) {
  auto info = initialised(focal_detection_info_init);
  check(focal_detection_get_info(detection, &info));
  Json warnings = Json::array(), landmarks = Json::array();
  for (uint32_t i = 0; i < info.warning_count; ++i) warnings.push_back(focal_detection_warning(detection, i));
  for (const focal_landmark& landmark : landmarks_of(detection)) landmarks.push_back(landmark_json(landmark));
  return {{"mesh", mesh},
          {"vertices", info.vertex_count},
          {"triangles", info.triangle_count},
          {"warnings", warnings},
          {"seconds", seconds_json(detection)},
          {"peak_memory_bytes", focal_peak_memory_bytes()},
          {"backend", backend_name(info.backend)},
          {"landmarks", landmarks},
          {"category_fit", info.category_fit}};
}

Landmark file_landmark(const focal_landmark& landmark) {
  Landmark mark;
  mark.name = landmark.name;
  mark.status = status_name(landmark.status);
  mark.confidence = landmark.confidence;
  if (landmark.point.triangle == FOCAL_NO_TRIANGLE) {
    mark.status = "absent";
    return mark;
  }
  const float* w = landmark.point.barycentric;
  mark.surface = SurfacePlace{landmark.point.triangle, {tidy(w[0]), tidy(w[1]), tidy(w[2])}};
  mark.vertex = landmark.vertex;
  const float* xyz = landmark.position;
  mark.position = Position{tidy(xyz[0]), tidy(xyz[1]), tidy(xyz[2])};
  return mark;
}

void write_output(const focal_detection* detection, const DetectOptions& options) {
  if (is_gltf(options.output)) return check(focal_detection_write_gltf(detection, options.output.c_str()));
  LandmarkFile file{text_of(path_of(options.mesh).filename()), {}};
  for (const focal_landmark& landmark : landmarks_of(detection))
    file.landmarks.push_back(file_landmark(landmark));
  write_landmark_file(options.output, file);
}

void print_detection(const Json& report) {
  std::vector<std::vector<std::string>> rows = {
      {"landmark", "status", "confidence", "x", "y", "z", "error +-"}};
  for (const Json& landmark : report["landmarks"]) {
    std::vector<std::string> row = {landmark["name"], landmark["status"],
                                    percent_text(landmark["confidence"].get<double>(), 0)};
    for (size_t axis = 0; axis < 3; ++axis) {
      const Json& position = landmark["position"];
      row.push_back(position.is_null() ? "-" : fixed_text(position[axis].get<double>(), 4));
    }
    row.push_back(fixed_text(landmark["expected_error"].get<double>(), 4));
    rows.push_back(std::move(row));
  }
  print_table(std::cout, rows);
  std::cout << "\n"
            << report["vertices"] << " vertices in "
            << fixed_text(report["seconds"]["total"].get<double>(), 2)
            << " s; fits the category: " << percent_text(report["category_fit"].get<double>(), 0) << "\n";
}

void detect(const DetectOptions& options) {
  for (const std::string& path : {options.output, options.votes}) {
    if (!path.empty()) check_output_folder(path);
  }
  if (!options.output.empty() && !is_gltf(options.output)) landmark_format_of(options.output);
  const Context context = make_context(options);
  Progress progress(options.quiet);
  const auto model = load_model(context.get(), options.model);
  const Mesh mesh = load_mesh(context.get(), options.mesh, options);
  auto params = detect_params_of(options, options);
  params.keep_votes = !options.votes.empty();
  const auto detection =
      owned<Detection>(focal_model_detect, model.get(), mesh.get(), &params, progress.begin("detecting"));
  progress.clear();
  if (!options.output.empty()) write_output(detection.get(), options);
  if (!options.votes.empty()) check(focal_detection_write_votes_gltf(detection.get(), options.votes.c_str()));
  const Json report = detection_json(detection.get(), options.mesh);
  if (options.json) print_json(report);
  if (!options.prints_text()) return;
  print_detection(report);
  for (const Json& warning : report["warnings"])
    std::cerr << "warning: " << warning.get<std::string>() << "\n";
}

}  // namespace

void add_detect(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("detect", "Find a model's landmarks on a mesh");
  const auto options = std::make_shared<DetectOptions>();
  add_model_argument(*verb, options->model);
  verb->add_option("MESH", options->mesh, "glTF file, .glb or .gltf")->type_name("")->required();
  verb->add_option(
          "-o,--output", options->output,
          "Landmarks to write: .landmarks.json, .mrk.json, .fcsv, .csv or .pp; .glb or .gltf: the mesh's "
          "own file with a node at each landmark")
      ->type_name("OUT");
  verb->add_option("--votes", options->votes, "Vote maps to write, as vertex colours (glTF)")
      ->type_name("OUT.glb");
  add_detection_options(*verb, *options);
  add_mesh_options(*verb, *options);
  add_common_options(*verb, *options);
  verb->callback([options] { detect(*options); });
}

}  // namespace focal_cli
