// focal segment: the parts of a mesh under the model's names.
#include <iostream>
#include <set>

#include "evaluation/outcomes.h"
#include "files.h"
#include "marked_mesh.h"
#include "models.h"
#include "output.h"
#include "parameters.h"
#include "progress.h"
#include "text_table.h"

namespace focal_cli {
namespace {

struct SegmentOptions : CommonOptions, DetectionOptions {
  std::string model, mesh, output;
  focal_segmentation method = FOCAL_SEGMENTATION_AUTO;
};

// Which names the labels stand for.
std::vector<std::string> label_names(const focal_model* model, focal_segmentation method) {
  const bool joints = method == FOCAL_SEGMENTATION_SKELETON ||
                      (method == FOCAL_SEGMENTATION_AUTO && focal_model_joint_count(model) > 0);
  return joints ? joint_names_of(model) : landmark_names_of(model);
}

void segment(const SegmentOptions& options) {
  check_output_folder(options.output);
  const Context context = make_context(options);
  Progress progress(options.quiet);
  const auto model = load_model(context.get(), options.model);
  const Mesh mesh = load_mesh(context.get(), options.mesh, options);
  auto params = detect_params_of(options, options);
  params.keep_votes = 0;
  const auto detection = owned<Detection>(focal_model_detect, model.get(), mesh.get(), &params,
                                          progress.begin("detecting", 0, 2));
  std::vector<int32_t> labels(info_of(mesh.get()).triangle_count);
  check(focal_detection_segment(detection.get(), options.method, progress.begin("segmenting", 1, 2),
                                labels.size(), labels.data()));
  check(focal_detection_write_segments_gltf(detection.get(), options.method, options.output.c_str()));
  const std::vector<std::string> names = label_names(model.get(), options.method);
  std::vector<size_t> count(names.size(), 0);
  for (const int32_t label : labels)
    if (label >= 0) ++count[static_cast<size_t>(label)];
  Json parts = Json::array();
  for (size_t i = 0; i < names.size(); ++i) parts.push_back({{"name", names[i]}, {"triangles", count[i]}});
  const Json report = {
      {"mesh", options.mesh}, {"output", options.output}, {"parts", parts}, {"labels", labels}};
  const std::string sidecar = options.output.substr(0, options.output.rfind('.')) + ".labels.json";
  write_file_atomically(sidecar, report.dump() + "\n");
  progress.clear();
  if (options.json) print_json(report);
  if (!options.prints_text()) return;
  std::vector<std::vector<std::string>> rows = {{"part", "triangles"}};
  for (size_t i = 0; i < names.size(); ++i) rows.push_back({names[i], std::to_string(count[i])});
  print_table(std::cout, rows);
  std::cout << "\n"
            << options.output << " shows the parts; " << sidecar << " holds a label for each triangle.\n";
}

}  // namespace

void add_segment(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("segment", "Divide a mesh into parts under the model's names");
  const auto options = std::make_shared<SegmentOptions>();
  add_model_argument(*verb, options->model);
  verb->add_option("MESH", options->mesh, "glTF file, .glb or .gltf")->type_name("")->required();
  verb->add_option("-o,--output", options->output,
                   "The mesh with its parts as vertex colours; OUT.labels.json beside it gets a label for "
                   "each triangle")
      ->type_name("OUT.glb")
      ->required();
  add_choice(*verb, "--method", options->method,
             "auto: by joints where the model has a skeleton, else by the landmark nearest along the "
             "surface; k-means: as in "
             "Xia et al. 2016",
             "auto|skeleton|geodesic|k-means",
             {{"auto", FOCAL_SEGMENTATION_AUTO},
              {"skeleton", FOCAL_SEGMENTATION_SKELETON},
              {"geodesic", FOCAL_SEGMENTATION_GEODESIC},
              {"k-means", FOCAL_SEGMENTATION_K_MEANS}});
  add_detection_options(*verb, *options);
  add_mesh_options(*verb, *options);
  add_common_options(*verb, *options);
  verb->callback([options] { segment(*options); });
}

}  // namespace focal_cli
