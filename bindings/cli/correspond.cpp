// focal correspond: which point of one mesh is which of another.
#include <iostream>

#include "files.h"
#include "landmark_text.h"
#include "marked_mesh.h"
#include "models.h"
#include "output.h"
#include "parameters.h"
#include "progress.h"
#include "text_table.h"

namespace focal_cli {
namespace {

using Correspondence = Owned<focal_correspondence, focal_correspondence_destroy>;

struct CorrespondOptions : CommonOptions, DetectionOptions {
  std::string model, from, to, output;
  bool dense = false;
};

Json point_json(const focal_surface_point& point) {
  if (point.triangle == FOCAL_NO_TRIANGLE) return nullptr;
  const float* w = point.barycentric;
  return {{"triangle", point.triangle}, {"barycentric", {tidy(w[0]), tidy(w[1]), tidy(w[2])}}};
}

Json landmark_pairs(const focal_detection* from, const focal_detection* to) {
  Json pairs = Json::array();
  for (uint32_t i = 0; i < focal_detection_landmark_count(from); ++i) {
    auto a = initialised(focal_landmark_init), b = initialised(focal_landmark_init);
    check(focal_detection_get_landmark(from, i, &a));
    check(focal_detection_get_landmark(to, i, &b));
    if (a.status == FOCAL_LANDMARK_ABSENT || b.status == FOCAL_LANDMARK_ABSENT) continue;
    pairs.push_back({{"name", a.name},
                     {"from", point_json(a.point)},
                     {"to", point_json(b.point)},
                     {"confidence", std::min(a.confidence, b.confidence)}});
  }
  return pairs;
}

Json dense_json(const focal_detection* from, const focal_detection* to, const focal_mesh* mesh,
                focal_task* task) {
  const auto map = owned<Correspondence>(focal_correspondence_create, from, to, task);
  std::vector<focal_surface_point> points(info_of(mesh).vertex_count);
  check(focal_correspondence_points(map.get(), points.size(), points.data()));
  Json list = Json::array();
  for (const focal_surface_point& point : points) list.push_back(point_json(point));
  return list;
}

void correspond(const CorrespondOptions& options) {
  check_output_folder(options.output);
  const Context context = make_context(options);
  Progress progress(options.quiet);
  const auto model = load_model(context.get(), options.model);
  const Mesh from = load_mesh(context.get(), options.from, options),
             to = load_mesh(context.get(), options.to, options);
  auto params = detect_params_of(options, options);
  params.keep_votes = 0;
  const auto a = owned<Detection>(focal_model_detect, model.get(), from.get(), &params,
                                  progress.begin("detecting", 0, 3));
  const auto b =
      owned<Detection>(focal_model_detect, model.get(), to.get(), &params, progress.begin("detecting", 1, 3));
  Json report = {{"from", options.from}, {"to", options.to}, {"landmarks", landmark_pairs(a.get(), b.get())}};
  if (options.dense)
    report["vertices"] = dense_json(a.get(), b.get(), from.get(), progress.begin("mapping", 2, 3));
  write_file_atomically(options.output, report.dump(options.dense ? -1 : 1) + "\n");
  progress.clear();
  if (options.json) print_json(report);
  if (!options.prints_text()) return;
  std::cout << report["landmarks"].size() << " landmarks";
  if (options.dense) std::cout << " and " << report["vertices"].size() << " vertices";
  std::cout << " of " << options.from << " correspond to points of " << options.to << ": " << options.output
            << "\n";
}

}  // namespace

void add_correspond(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("correspond", "Find corresponding points of two meshes");
  const auto options = std::make_shared<CorrespondOptions>();
  add_model_argument(*verb, options->model);
  verb->add_option("A", options->from, "glTF file: each of its landmarks or vertices ...")
      ->type_name("")
      ->required();
  verb->add_option("B", options->to, "glTF file: ... gets a point of this one")->type_name("")->required();
  verb->add_option("-o,--output", options->output, "File to write")->type_name("OUT.json")->required();
  verb->add_flag("--dense", options->dense, "Also find a point for every vertex of A");
  add_detection_options(*verb, *options);
  add_mesh_options(*verb, *options);
  add_common_options(*verb, *options);
  verb->callback([options] { correspond(*options); });
}

}  // namespace focal_cli
