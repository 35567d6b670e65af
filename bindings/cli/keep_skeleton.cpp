#include "keep_skeleton.h"

#include <chrono>
#include <iostream>

#include "marked_mesh.h"
#include "output.h"
#include "progress.h"
#include "rig_report.h"
#include "text_table.h"

namespace focal_cli {

void keep_skeleton(const std::string& mesh, const std::string& output, int32_t influences,
                   const CommonOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check_output_folder(output);
  const Context context = make_context(options);
  Progress progress(options.quiet);
  const Mesh loaded = load_mesh(context.get(), mesh, options);
  auto params = initialised(focal_bind_params_init);
  params.max_influences = influences;
  const auto skeleton =
      owned<Skeleton>(focal_skeleton_bind, context.get(), loaded.get(), &params, progress.begin("weights"));
  check(focal_skeleton_write_gltf(skeleton.get(), output.c_str()));
  progress.clear();
  Json warnings = Json::array();
  const uint32_t count = info_of(loaded.get()).warning_count;
  for (uint32_t i = 0; i < count; ++i) warnings.push_back(focal_mesh_warning(loaded.get(), i));
  add_skeleton_warnings(warnings, skeleton.get());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Json report = {{"mesh", mesh},
                       {"output", output},
                       {"joints", joints_json(skeleton.get())},
                       {"weights", weights_json(skeleton.get())},
                       {"warnings", warnings},
                       {"seconds", seconds}};
  if (options.json) print_json(report);
  if (!options.prints_text()) return;
  std::cout << "Weights for the " << report["joints"].size() << " joints of " << mesh << ", which stay.\n"
            << output << " in " << fixed_text(seconds, 2) << " s\n";
  for (const Json& warning : warnings) std::cerr << "warning: " << warning.get<std::string>() << "\n";
}

}  // namespace focal_cli
