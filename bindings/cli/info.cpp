// focal info: what is in a model or a mesh.
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "evaluation/outcomes.h"
#include "files.h"
#include "marked_mesh.h"
#include "models.h"
#include "options.h"
#include "output.h"
#include "paths.h"
#include "text_table.h"

namespace focal_cli {
namespace {

struct InfoOptions : CommonOptions {
  std::string file;
};

// What is plainly no model is looked at as a mesh: the library says what it is.
bool is_mesh(const std::string& path) {
  std::array<char, 8> magic{};
  std::error_code unreadable;
  if (std::filesystem::is_regular_file(path_of(path), unreadable))  // a pipe or a device would block
    std::ifstream(path_of(path), std::ios::binary).read(magic.data(), magic.size());
  const std::string_view begin(magic.data(), magic.size());
  return is_gltf(path) || begin.starts_with("glTF") || (begin != "FOCALMDL" && !has_ending(path, ".focal"));
}

Json model_json(const focal_model* model, const std::string& path) {
  auto info = initialised(focal_model_info_init);
  auto params = initialised(focal_train_params_init);
  check(focal_model_get_info(model, &info));
  check(focal_model_get_train_params(model, &params));
  return {{"kind", "model"},
          {"file", path},
          {"file_bytes", info.file_bytes},
          {"preset", preset_name(info.preset)},
          {"landmarks", landmark_names_of(model)},
          {"joints", joint_names_of(model)},
          {"shapes", info.shape_count},
          {"mean_vertices", info.mean_vertex_count},
          {"samples", info.sample_count},
          {"tree_nodes", info.tree_node_count},
          {"parameters",
           {{"eigenpairs", params.eigenpair_count},
            {"trees", params.tree_count},
            {"min_leaf_samples", params.min_leaf_samples},
            {"components_per_split", params.components_per_split},
            {"sampling_rate", params.sampling_rate},
            {"max_samples_per_shape", params.max_samples_per_shape},
            {"proxy_vertices", params.proxy_vertices},
            {"seed", params.seed},
            {"descriptor", focal_descriptor_name(params.descriptor)},
            {"distance", focal_distance_name(params.distance)}}}};
}

const char* scenery_name(focal_scenery reason) {
  switch (reason) {
    case FOCAL_SCENERY_HIDDEN:
      return "hidden";
    case FOCAL_SCENERY_SHEET:
      return "sheet";
    case FOCAL_SCENERY_ENCLOSURE:
      return "enclosure";
    case FOCAL_SCENERY_APART:
      return "apart";
    default:
      return "unknown";
  }
}

Json left_out_json(const focal_mesh* mesh, uint32_t count) {
  Json list = Json::array();
  for (uint32_t i = 0; i < count; ++i) {
    auto one = initialised(focal_left_out_init);
    check(focal_mesh_get_left_out(mesh, i, &one));
    list.push_back({{"name", one.name},
                    {"reason", scenery_name(one.reason)},
                    {"triangles", one.triangle_count},
                    {"whole_node", one.is_whole_node != 0}});
  }
  return list;
}

Json mesh_json(const focal_mesh* mesh, const std::string& path) {
  const focal_mesh_info info = info_of(mesh);
  Json warnings = Json::array();
  for (uint32_t i = 0; i < info.warning_count; ++i) warnings.push_back(focal_mesh_warning(mesh, i));
  return {{"kind", "mesh"},
          {"file", path},
          {"vertices", info.vertex_count},
          {"triangles", info.triangle_count},
          {"analysed", info.is_wrapped ? "wrapped" : "as-is"},
          {"surface_vertices", info.surface_vertex_count},
          {"surface_triangles", info.surface_triangle_count},
          {"mean_edge_length", info.mean_edge_length},
          {"surface_area", info.surface_area},
          {"invalid_triangles", info.invalid_triangles},
          {"degenerate_triangles", info.degenerate_triangles},
          {"flipped_triangles", info.flipped_triangles},
          {"nonmanifold_edges", info.nonmanifold_edges},
          {"nonmanifold_vertices", info.nonmanifold_vertices},
          {"boundary_loops", info.boundary_loops},
          {"components", info.component_count},
          {"oriented", info.is_oriented != 0},
          {"left_out", left_out_json(mesh, info.left_out_count)},
          {"seconds", {{"load", info.load_seconds}, {"repair", info.repair_seconds}}},
          {"warnings", warnings}};
}

std::string plain_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_object()) return plain_text(value["name"]) + " (" + plain_text(value["reason"]) + ")";
  if (!value.is_array()) return value.dump();
  std::string list;
  for (const Json& entry : value) list += (list.empty() ? "" : ", ") + plain_text(entry);
  return list.empty() ? "-" : list;
}

void print_text(const Json& report) {
  std::vector<std::pair<std::string, std::string>> facts;
  for (const auto& [key, value] : report.items()) {
    if (!value.is_object()) facts.emplace_back(key, plain_text(value));
    if (!value.is_object()) continue;
    for (const auto& [inner, number] : value.items())
      facts.emplace_back(key + "." + inner, plain_text(number));
  }
  for (auto& [name, value] : facts) std::replace(name.begin(), name.end(), '_', ' ');
  print_facts(std::cout, facts);
}

void info(const InfoOptions& options) {
  const Context context = make_context(options);
  const bool shows_mesh = is_mesh(options.file) && !is_stock_model(context.get(), options.file);
  const Json report = shows_mesh
                          ? mesh_json(load_mesh(context.get(), options.file, options).get(), options.file)
                          : model_json(load_model(context.get(), options.file).get(), options.file);
  if (options.json) print_json(report);
  if (options.prints_text()) print_text(report);
}

}  // namespace

void add_info(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("info", "Show what is in a model or a mesh");
  const auto options = std::make_shared<InfoOptions>();
  verb->add_option("FILE", options->file, "Model file, name of a stock model, .glb or .gltf")
      ->type_name("")
      ->required();
  add_mesh_options(*verb, *options);
  add_common_options(*verb, *options, false);
  verb->callback([options] { info(*options); });
}

}  // namespace focal_cli
