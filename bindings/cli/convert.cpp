// focal convert: one landmark file format into another, or a mesh into the closed surface round it.
#include <iostream>

#include "command_error.h"
#include "files.h"
#include "landmark_files.h"
#include "marked_mesh.h"
#include "options.h"
#include "output.h"

namespace focal_cli {
namespace {

struct ConvertOptions : CommonOptions {
  std::string in, out;
};

// To look at what stands for a character of many parts in the analysis.
void convert_to_wrap(const ConvertOptions& options) {
  check_output_folder(options.out);
  const Context context = make_context(options);
  const Mesh mesh = load_mesh(context.get(), options.in, options);
  check(focal_mesh_write_wrap_gltf(mesh.get(), options.out.c_str()));
  const Mesh wrap = load_mesh(context.get(), options.out, {.surface = FOCAL_SURFACE_AS_IS});
  const focal_mesh_info from = info_of(mesh.get()), to = info_of(wrap.get());
  const char* analysed = from.is_wrapped ? "wrapped" : "as-is";
  if (options.json)
    print_json({{"in", options.in},
                {"out", options.out},
                {"vertices", to.vertex_count},
                {"triangles", to.triangle_count},
                {"analysed", analysed}});
  if (!options.prints_text()) return;
  std::cout << options.out << ": the closed surface around " << options.in << ", " << to.triangle_count
            << " triangles; the mesh is analysed " << (from.is_wrapped ? "so" : "as it is, not so") << "\n";
}

void convert(const ConvertOptions& options) {
  if (is_gltf(options.in) && is_gltf(options.out)) return convert_to_wrap(options);
  if (options.lenient || options.keep_scenery || options.surface != FOCAL_SURFACE_AUTO)
    throw CommandError("--lenient, --surface and --keep-scenery are for meshes",
                       "leave them out when you convert landmark files");
  const LandmarkFormat target = landmark_format_of(options.out);
  check_output_folder(options.out);
  const LandmarkFile file = read_landmark_file(options.in);
  write_landmark_file(options.out, file);
  Json written = Json::array(), left_out = Json::array();
  for (const Landmark& mark : file.landmarks) {
    (mark.absent() && target != LandmarkFormat::own_json ? left_out : written).push_back(mark.name);
  }
  if (options.json) {
    print_json({{"in", options.in}, {"out", options.out}, {"landmarks", written}, {"left_out", left_out}});
  }
  if (!options.prints_text()) return;
  std::cout << options.out << ": " << written.size() << " landmarks";
  if (!left_out.empty()) std::cout << "; " << left_out.size() << " absent ones left out";
  std::cout << "\n";
}

}  // namespace

void add_convert(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("convert",
                                      "Convert landmark files: .landmarks.json, 3D Slicer's .mrk.json and "
                                      ".fcsv, .csv, MeshLab's .pp; or write the "
                                      "closed surface around a mesh: CHARACTER.glb WRAP.glb");
  const auto options = std::make_shared<ConvertOptions>();
  verb->add_option("IN", options->in, "Landmark file or mesh to read")->type_name("")->required();
  verb->add_option("OUT", options->out, "File to write; its suffix chooses the format")
      ->type_name("")
      ->required();
  add_mesh_options(*verb, *options);
  add_common_options(*verb, *options, false);
  verb->callback([options] { convert(*options); });
}

}  // namespace focal_cli
