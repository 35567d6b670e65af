// focal convert: one landmark file format into another.
#include <iostream>

#include "landmark_files.h"
#include "options.h"
#include "output.h"

namespace focal_cli {
namespace {

struct Options : CommonOptions {
  std::string in, out;
};

void convert(const Options& options) {
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
  CLI::App* verb = app.add_subcommand(
      "convert",
      "Convert landmark files: .landmarks.json, 3D Slicer's .mrk.json and .fcsv, .csv, MeshLab's .pp");
  const auto options = std::make_shared<Options>();
  verb->add_option("IN", options->in, "Landmark file to read")->type_name("")->required();
  verb->add_option("OUT", options->out, "Landmark file to write; its ending chooses the format")
      ->type_name("")
      ->required();
  add_common_options(*verb, *options);
  verb->callback([options] { convert(*options); });
}

}  // namespace focal_cli
