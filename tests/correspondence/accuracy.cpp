// How far dense maps between people never trained on lie from the truth: mean geodesic error, x 100 / sqrt(area), on faust5k.
// Not a test with bounds: the figures go into docs/accuracy.md.
//   focal_map_accuracy MODEL [--pairs N] [--split test|extra]
// MODEL: trained on faust5k's train split. Pairs go from each mesh to one further on, another person where N allows.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>

#include "base/atomic_file.h"
#include "base/random.h"
#include "base/stopwatch.h"
#include "correspondence/dense_map.h"
#include "evaluation_data.h"
#include "model/model_file.h"

namespace {

using namespace focal;

constexpr int32_t judged_points = 300;   // of each pair
constexpr double near = 0.1;             // of sqrt(area): below, a straight line is as good as a geodesic
constexpr double mirrored_error = 0.25;  // mean of a pair, likewise: something is turned round
const Execution execution;               // one a core

struct Subject {
  std::shared_ptr<const PreparedMesh> mesh;
  std::vector<int32_t> row;  // vertex of each body point
  Detection detection;
};

Subject load(const std::shared_ptr<const LandmarkModel>& model, const std::filesystem::path& set,
             const std::string& name) {
  Subject subject;
  subject.mesh =
      std::make_shared<const PreparedMesh>(prepare(focal_test::read_evaluation_mesh(set / (name + ".glb"))));
  std::ifstream rows(set / (name + ".corr.txt"));
  for (int32_t vertex; rows >> vertex;) subject.row.push_back(vertex);
  subject.detection = detect(model, subject.mesh, {}, execution);
  return subject;
}

// Mean over random body points.
double error_of(const DenseMap& map, const Subject& from, const Subject& to, Random random) {
  std::vector<SurfacePoint> truth;
  std::vector<Vector3> straight;
  std::vector<SurfacePoint> found;
  const PreparedMesh& mesh = *to.mesh;
  while (truth.size() < judged_points) {
    const uint32_t row = random.below(static_cast<uint32_t>(from.row.size()));
    const SurfacePoint& image = map.point[from.row[row]];
    if (image.triangle < 0) continue;
    truth.push_back(at_vertex(mesh.surface, mesh.surface_vertex[to.row[row]]));
    found.push_back(to_surface(mesh, image));
  }
  const auto at = to_coarse(to.detection.proxy, truth), images = to_coarse(to.detection.proxy, found);
  const RowMatrixf fields = to.detection.analysis->metric->distances(at, execution);
  double sum = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    const double line = (position_of(mesh.surface, truth[i]) - position_of(mesh.surface, found[i])).norm();
    double along = 0;
    for (int c = 0; c < 3; ++c)
      along += images[i].barycentric[c] *
               fields(static_cast<Eigen::Index>(i),
                      to.detection.proxy.coarse->surface.triangles(images[i].triangle, c));
    sum += line < near ? line : std::max(line, along);
  }
  return sum / static_cast<double>(truth.size());
}

}  // namespace

int main(int count, char** arguments) {
  std::map<std::string, std::string> options{{"--pairs", "20"}, {"--split", "test"}};
  for (int i = 2; i + 1 < count; i += 2) options[arguments[i]] = arguments[i + 1];
  if (count < 2) return std::cerr << "usage: focal_map_accuracy MODEL [--pairs N] [--split NAME]\n", 2;
  const auto set = focal_test::evaluation_set("faust5k");
  if (!set) return 0;
  const auto model = std::make_shared<const LandmarkModel>(parse_model(read_file(arguments[1])));
  const auto sets = focal_test::read_json(*set / "set.json");
  const auto names = sets[options["--split"]].get<std::vector<std::string>>();
  std::map<size_t, Subject> subjects;
  const auto subject = [&](size_t i) -> const Subject& {
    if (!subjects.contains(i)) subjects[i] = load(model, *set, names[i]);
    return subjects[i];
  };
  std::vector<double> errors, seconds;
  int mirrored = 0;
  const size_t step = names.size() / 2 + 1;
  for (int pair = 0; pair < std::stoi(options["--pairs"]); ++pair) {
    const size_t a = static_cast<size_t>(pair) % names.size(),
                 b = (a + step + static_cast<size_t>(pair) / names.size()) % names.size();
    subject(a), subject(b);
    Stopwatch watch;
    const DenseMap map = dense_map(subjects[a].detection, subjects[b].detection, execution);
    seconds.push_back(watch.lap());
    errors.push_back(error_of(map, subjects[a], subjects[b], Random(1, static_cast<uint64_t>(pair))));
    mirrored += errors.back() > mirrored_error;
    std::printf("%s -> %s  %.2f  residual %.3f  %.2f s\n", names[a].c_str(), names[b].c_str(),
                100 * errors.back(), map.residual, seconds.back());
  }
  double mean = 0, time = 0;
  for (size_t i = 0; i < errors.size(); ++i) mean += errors[i], time += seconds[i];
  std::printf("%zu pairs: mean %.2f, %d turned round, %.2f s a pair\n", errors.size(),
              100 * mean / static_cast<double>(errors.size()), mirrored,
              time / static_cast<double>(errors.size()));
  return 0;
}
