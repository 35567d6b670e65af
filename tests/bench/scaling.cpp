// focal_bench_scaling: seconds and memory of a detection as the mesh grows from 5 thousand vertices to a million. Each
// size runs in a process of its own, so that peak memory is that of one detection. Prints a table, or rows of JSON, and
// draws the picture for the docs.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "large_mesh.h"
#include "model/model_file.h"
#include "scaling_picture.h"
#include "stages.h"
#include "timing.h"

namespace {

using namespace focal_bench;
namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Options {
  std::vector<int32_t> sizes = {5000, 12500, 50000, 125000, 500000, 1000000};
  int threads = 2, runs = 5;
  bool json = false;
  std::string picture, mesh, model;  // mesh, model: of the process that measures one size
};

void write_mesh(const focal::TriangleMesh& mesh, const fs::path& path) {
  const int64_t counts[2] = {mesh.vertex_count(), mesh.triangle_count()};
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(counts), sizeof counts);
  file.write(reinterpret_cast<const char*>(mesh.positions.data()), mesh.positions.size() * sizeof(double));
  file.write(reinterpret_cast<const char*>(mesh.triangles.data()), mesh.triangles.size() * sizeof(int32_t));
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

focal::TriangleMesh read_mesh(const fs::path& path) {
  int64_t counts[2];
  focal::TriangleMesh mesh;
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(counts), sizeof counts);
  mesh.positions.resize(counts[0], 3);
  mesh.triangles.resize(counts[1], 3);
  file.read(reinterpret_cast<char*>(mesh.positions.data()), mesh.positions.size() * sizeof(double));
  file.read(reinterpret_cast<char*>(mesh.triangles.data()), mesh.triangles.size() * sizeof(int32_t));
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return mesh;
}

// VmHWM, the largest resident memory so far, or VmRSS, that of now; in MB.
double process_memory(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(name + ":")) return std::stod(line.substr(name.size() + 1)) / 1024;
  return 0;
}

Json stage_seconds(const focal::StageSeconds& s) {
  return {{"proxy", s.proxy},
          {"spectrum", s.spectrum},
          {"descriptors", s.descriptors},
          {"geodesics", s.geodesics},
          {"forest", s.forest},
          {"vote", s.vote},
          {"constellation", s.constellation},
          {"refine", s.refine}};
}

// In a process of its own. Memory: all that the process holds at most, and what it held before, which is the host's
// mesh, the model and the program.
void measure_one(const Options& options) {
  const auto model =
      std::make_shared<focal::LandmarkModel>(focal::parse_model(focal::read_file(options.model)));
  const auto mesh = read_mesh(options.mesh);
  const double before = process_memory("VmRSS");
  std::ofstream("/proc/self/clear_refs") << 5;  // the peak starts anew: reading the files does not count
  std::vector<double> prepare_seconds, detect_seconds;
  focal::Detection detection;
  double spent = 0;
  for (int run = 0; run < options.runs && (run == 0 || spent < 30); ++run) {
    detection = {};  // as a host that keeps one at a time
    std::shared_ptr<const focal::PreparedMesh> prepared;
    prepare_seconds.push_back(
        seconds_of([&] { prepared = std::make_shared<focal::PreparedMesh>(focal::prepare(mesh)); }).wall);
    detect_seconds.push_back(seconds_of([&] {
                               detection = focal::detect(model, prepared, detect_variants()[0].params,
                                                         threads_of(options.threads));
                             }).wall);
    spent += prepare_seconds.back() + detect_seconds.back();
  }
  const Json row = {{"vertices", mesh.vertex_count()},
                    {"runs", detect_seconds.size()},
                    {"prepare_seconds", median(prepare_seconds)},
                    {"detect_seconds", median(detect_seconds)},
                    {"stages", stage_seconds(detection.seconds)},
                    {"memory_before_mb", before},
                    {"peak_memory_mb", process_memory("VmHWM")}};
  std::printf("%s\n", row.dump().c_str());
}

Json run_child(const Options& options, const fs::path& mesh, const fs::path& model) {
  const std::string command = "'" + fs::read_symlink("/proc/self/exe").string() + "' --mesh '" +
                              mesh.string() + "' --model '" + model.string() + "' --threads " +
                              std::to_string(options.threads) + " --runs " + std::to_string(options.runs);
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot start the process that measures one size");
  std::string output;
  char buffer[4096];
  while (const size_t read = std::fread(buffer, 1, sizeof buffer, pipe)) output.append(buffer, read);
  if (pclose(pipe) != 0 || output.empty()) return Json();  // it ran out of memory, or was stopped
  return Json::parse(output);
}

void print_row(const Json& row) {
  std::printf("| %d | %.3f | %.3f |", row["vertices"].get<int>(), row["prepare_seconds"].get<double>(),
              row["detect_seconds"].get<double>());
  for (const auto& seconds : row["stages"]) std::printf(" %.3f |", seconds.get<double>());
  std::printf(" %.0f | %.0f |\n", row["memory_before_mb"].get<double>(), row["peak_memory_mb"].get<double>());
  std::fflush(stdout);
}

void print_header(const std::string& subject, const Options& options) {
  std::printf("%s, resized; %d threads; medians of up to %d runs.\n\n| vertices | prepare, s | detect, s |",
              subject.c_str(), options.threads, options.runs);
  const Json stages = stage_seconds({});
  for (const auto& [name, seconds] : stages.items()) std::printf(" %s |", name.c_str());
  std::printf(" MB before | peak MB |\n|%s\n", "---|---|---|---|---|---|---|---|---|---|---|---|---|");
}

void measure_all(const Options& options) {
  const fs::path folder = fs::temp_directory_path() / ("focal_bench_scaling_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const Subject subject = set_or_people("faust12k");
  focal::write_file_atomically(
      folder / "model",
      focal::serialise(*trained(subject, focal::TrainParams::from_preset(focal::Preset::default_preset),
                                options.threads)));
  const auto welded = focal::prepare(subject.test).surface;
  Json rows = Json::array();
  if (!options.json) print_header(subject.name, options);
  for (const int32_t size : options.sizes) {
    const auto mesh = resized(welded, size, static_cast<uint64_t>(size));
    if (open_edges(mesh) > open_edges(welded)) throw std::logic_error("resizing tore the mesh open");
    write_mesh(mesh, folder / "mesh");
    const Json row = run_child(options, folder / "mesh", folder / "model");
    if (row.is_null()) {
      std::fprintf(stderr, "%d vertices: the detection failed or was stopped\n", size);
      continue;
    }
    if (!options.json) print_row(row);
    rows.push_back(row);
  }
  fs::remove_all(folder);
  if (options.json) std::printf("%s\n", rows.dump(1).c_str());
  if (!options.picture.empty()) std::ofstream(options.picture) << scaling_picture(rows);
}

}  // namespace

int main(int argc, char** argv) try {
  Options options;
  CLI::App app("detection as the mesh grows");
  app.add_option("--sizes", options.sizes, "numbers of vertices")->delimiter(',');
  app.add_option("--threads", options.threads)->check(CLI::PositiveNumber);
  app.add_option("--runs", options.runs, "of each size; fewer when they take long")
      ->check(CLI::PositiveNumber);
  app.add_flag("--json", options.json, "print rows as JSON");
  app.add_option("--svg", options.picture, "draw seconds and memory into this file");
  app.add_option("--mesh", options.mesh, "measure this mesh only, in this process")->group("");
  app.add_option("--model", options.model)->group("");
  CLI11_PARSE(app, argc, argv);
  options.mesh.empty() ? measure_all(options) : measure_one(options);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "focal_bench_scaling: %s\n", error.what());
  return 1;
}
