// focal doctor: what this installation is and can do.
#include <iostream>
#include <thread>

#include "models.h"
#include "options.h"
#include "output.h"
#include "text_table.h"

namespace focal_cli {
namespace {

Json diagnosis(const focal_context* context) {
  Json stock = Json::array();
  for (const StockModel& one : stock_models(context))
    stock.push_back({{"name", one.name}, {"file", one.path}});
  const auto limits = initialised(focal_mesh_params_init);
  return {{"version", focal_version_string()},
          {"backend",
           {{"used", backend_name(focal_context_backend(context))},
            {"reason", focal_context_backend_reason(context)}}},
          {"threads",
           {{"used", focal_context_thread_count(context)}, {"cores", std::thread::hardware_concurrency()}}},
          {"limits",
           {{"max_vertices", limits.max_vertices},
            {"max_nodes", limits.max_nodes},
            {"max_json_bytes", limits.max_json_bytes},
            {"max_file_bytes", limits.max_file_bytes}}},
          {"stock_models", stock},
          {"peak_memory_bytes", focal_peak_memory_bytes()}};
}

std::string stock_text(const Json& models) {
  std::string names;
  for (const Json& one : models) names += (names.empty() ? "" : ", ") + one["name"].get<std::string>();
  return names.empty() ? "none (samples/stock/make.sh makes them; FOCAL_MODELS names their folder)" : names;
}

void print_diagnosis(const Json& report) {
  const auto number = [](const Json& value) { return value.dump(); };
  const Json& limits = report["limits"];
  print_facts(std::cout,
              {{"focal", report["version"].get<std::string>()},
               {"backend", report["backend"]["used"].get<std::string>() + " (" +
                               report["backend"]["reason"].get<std::string>() + ")"},
               {"threads",
                number(report["threads"]["used"]) + " of " + number(report["threads"]["cores"]) + " cores"},
               {"stock models", stock_text(report["stock_models"])},
               {"largest mesh",
                number(limits["max_vertices"]) + " vertices, " + number(limits["max_nodes"]) + " nodes"},
               {"largest file", bytes_text(limits["max_file_bytes"].get<double>()) + ", its JSON " +
                                    bytes_text(limits["max_json_bytes"].get<double>())}});
}

}  // namespace

void add_doctor(CLI::App& app) {
  CLI::App* verb = app.add_subcommand(
      "doctor", "Show version, backend and the reason for it, threads, stock models and limits");
  const auto options = std::make_shared<CommonOptions>();
  add_common_options(*verb, *options, false);
  verb->callback([options] {
    const Context context = make_context(*options);
    const Json report = diagnosis(context.get());
    if (options->json) print_json(report);
    if (options->prints_text()) print_diagnosis(report);
  });
}

}  // namespace focal_cli
