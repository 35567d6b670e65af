// All backends, stage by stage, against the CPU: one after the other on surfaces that are easy and surfaces that are not, then
// whole detections; and, where the module can be told to fail, every way of failing.
// usage: focal_backend_test DRIVER MODULE [doctest options]. Exit code 77: there is no such device.
#define DOCTEST_CONFIG_IMPLEMENT
#include <dlfcn.h>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/random.h"
#include "compute/host_queue.h"
#include "compute/module_loader.h"
#include "creatures/character.h"
#include "descriptors/si_hks.h"
#include "geodesics/heat_method.h"
#include "landmarks/backend_surface.h"
#include "landmarks/detect.h"
#include "landmarks/leaf_votes.h"
#include "landmarks/train.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

#ifdef FOCAL_SANITIZED  // many times slower: the same code, on less, where landmarks are not as sure
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

BackendFiles files;
std::shared_ptr<Backend> backend;

// The counters of a module that can be told to fail, or null.
HostFaults* faults() {
  void* module = dlopen(files.module.c_str(), RTLD_NOW | RTLD_NOLOAD);
  void* found = module ? dlsym(module, "focal_host_faults") : nullptr;
  return found ? reinterpret_cast<HostFaults* (*)()>(found)() : nullptr;
}

struct Subject {
  const char* name;
  std::shared_ptr<const PreparedMesh> mesh;
  Operators operators;
};

Subject subject(const char* name, TriangleMesh mesh) {
  auto prepared = std::make_shared<const PreparedMesh>(prepare(std::move(mesh)));
  Operators operators = make_operators(prepared->surface, prepared->bridges, true);
  return {name, std::move(prepared), std::move(operators)};
}

TriangleMesh stretched(TriangleMesh mesh, double factor) {
  mesh.positions.col(0) *= factor;
  return mesh;
}

TriangleMesh twice(const TriangleMesh& mesh) {
  TriangleMesh both = mesh;
  const int32_t n = mesh.vertex_count(), m = mesh.triangle_count();
  both.positions.conservativeResize(2 * n, 3), both.triangles.conservativeResize(2 * m, 3);
  both.positions.bottomRows(n) = mesh.positions.rowwise() + Eigen::RowVector3d(3, 0.1, 0);
  both.triangles.bottomRows(m) = mesh.triangles.array() + n;
  return both;
}

const std::vector<Subject>& subjects() {
  static const std::vector<Subject> all = [] {
    std::vector<Subject> made;
    const int level = sanitized ? 3 : 4;
    made.push_back(subject("lump", with_radius(sphere(level), lump)));
    made.push_back(subject("mirror lump", with_radius(sphere(level), mirror_lump)));
    made.push_back(subject("sphere", sphere(level)));
    made.push_back(subject("jittered square", square(sanitized ? 8 : 14, 0.45)));
    made.push_back(subject("Moebius strip", moebius_strip(sanitized ? 40 : 60, sanitized ? 6 : 10)));
    made.push_back(subject("book", book(sanitized ? 5 : 8)));
    made.push_back(subject("needle", stretched(with_radius(sphere(level), lump), 30)));
    made.push_back(subject("two parts", twice(with_radius(sphere(3), lump))));
    return made;
  }();
  return all;
}

struct OnDevice {
  explicit OnDevice(const Subject& of)
      : distance(std::make_shared<BackendDistance>(of.mesh, of.operators, false, *backend)),
        surface(*distance->surface()) {}
  std::shared_ptr<BackendDistance> distance;
  const BackendSurface& surface;
};

constexpr int32_t eigenpairs = 60;
EigenParams eigen_params() {
  EigenParams params;
  params.count = eigenpairs, params.tolerance = 1e-7;
  return params;
}

void tell(const char* stage, const Subject& of, double difference, double allowed) {
  std::printf("%-10s %-16s %8.1e of %8.1e allowed\n", stage, of.name, difference, allowed);
  CHECK_MESSAGE(difference <= allowed, stage << ", " << of.name << ": " << difference);
}

std::vector<int32_t> some_vertices(const Subject& of, int32_t count) {
  Random random(3);
  const int32_t n = of.mesh->surface.vertex_count();
  return sample_without_replacement(random, n, std::min(count, n));
}

}  // namespace

TEST_CASE("heat distances") {
  for (const Subject& of : subjects()) {
    const OnDevice device(of);
    const HeatMethod cpu(of.mesh->surface, of.operators);
    REQUIRE(device.distance->distance_bound() == cpu.distance_bound());
    Random random(1);
    std::vector<SurfacePoint> sources;
    for (int i = 0; i < 70; ++i) {  // more than two blocks
      SurfacePoint point;
      point.triangle = static_cast<int32_t>(random.uniform() * of.mesh->surface.triangle_count());
      const double a = random.uniform(), b = random.uniform() * (1 - a);
      point.barycentric = {a, b, 1 - a - b};
      sources.push_back(point);
    }
    const RowMatrixf ours = device.distance->distances(sources, {}), theirs = cpu.distances(sources, {});
    tell("heat", of, (ours - theirs).cwiseAbs().maxCoeff() / theirs.maxCoeff(), 1e-5);
  }
}

TEST_CASE("eigenpairs") {
  for (const Subject& of : subjects()) {
    const OnDevice device(of);
    const Eigenbasis ours = device.surface.spectrum(eigen_params());
    const Eigenbasis theirs = eigenbasis(of.operators.L, of.operators.mass, eigen_params(), {});
    const double scale = theirs.lambda(eigenpairs - 1);
    tell("lambda", of, (ours.lambda - theirs.lambda).cwiseAbs().maxCoeff() / scale, 1e-12);
    const Matrix gram = ours.Phi.transpose() * of.operators.mass.asDiagonal() * ours.Phi;
    tell("orthogonal", of, (gram - Matrix::Identity(eigenpairs, eigenpairs)).cwiseAbs().maxCoeff(), 1e-12);
    const Matrix residual =
        of.operators.L * ours.Phi - of.operators.mass.asDiagonal() * ours.Phi * ours.lambda.asDiagonal();
    const Vector weight = of.operators.mass.cwiseSqrt().cwiseInverse();
    tell("residual", of, (weight.asDiagonal() * residual).colwise().norm().maxCoeff() / scale, 2e-7);
  }
}

TEST_CASE("signatures") {
  for (const Subject& of : subjects()) {
    const OnDevice device(of);
    const Eigenbasis basis = device.surface.spectrum(eigen_params());
    const auto vertices = some_vertices(of, 100);
    const RowMatrixf ours = device.surface.si_hks(basis.lambda, of.operators.area, vertices);
    const RowMatrix theirs = si_hks(basis, of.operators.area, vertices);
    tell("signatures", of, (ours.cast<double>() - theirs).cwiseAbs().maxCoeff() / theirs.maxCoeff(), 1e-6);
  }
}

namespace {

// Any model will do: random leaves over what the descriptors say.
std::shared_ptr<LandmarkModel> random_model(const RowMatrixf& descriptors, int32_t landmarks) {
  Random random(9);
  auto model = std::make_shared<LandmarkModel>();
  model->landmark_names.assign(static_cast<size_t>(landmarks), "mark");
  RowMatrixf targets(descriptors.rows(), landmarks);
  model->targets.resize(descriptors.rows(), landmarks);
  model->reach = 2.2F;
  for (Eigen::Index i = 0; i < targets.size(); ++i) {
    model->targets.data()[i] = static_cast<uint16_t>(random.uniform() * target_steps);
    targets.data()[i] = static_cast<float>(model->targets.data()[i]) / target_steps * model->reach;
    if (random.uniform() < 0.1) model->targets.data()[i] = target_missing;
  }
  ForestParams params;
  params.tree_count = 8;
  model->forests.push_back(grow_forest(bin_descriptors(descriptors, {}), targets, params, {}));
  return model;
}

RowMatrixf votes_of_cpu(const LandmarkModel& model, const HeatMethod& metric,
                        std::span<const int32_t> samples, const RowMatrixf& descriptors) {
  const auto count = static_cast<int32_t>(samples.size()), n = metric.vertex_count();
  const VoteTables tables = LeafVotes(model, descriptors, {}).tables(0, count, {});
  const double step = metric.distance_bound() / 65535;
  std::vector<uint16_t> steps(static_cast<size_t>((count + 31) / 32 * 32) * static_cast<size_t>(n));
  metric.for_each_block(samples, {}, [&](int64_t first, int32_t, const float* distances) {
    for (int64_t i = 0; i < int64_t{n} * 32; ++i)
      steps[static_cast<size_t>(first * n + i)] = static_cast<uint16_t>(std::lround(distances[i] / step));
  });
  RowMatrixf votes = RowMatrixf::Zero(n, tables.stride());
  add_distribution_votes(tables, count, {steps.data(), step, n}, 0, votes, {});
  return votes;
}

}  // namespace

TEST_CASE("votes") {
  for (const Subject& of : subjects()) {
    const OnDevice device(of);
    const HeatMethod cpu(of.mesh->surface, of.operators);
    const auto samples = some_vertices(of, 300);  // more than the device takes at once, and no multiple of 32
    Random random(4);
    RowMatrixf descriptors(samples.size(), 96);
    for (Eigen::Index i = 0; i < descriptors.size(); ++i)
      descriptors.data()[i] = static_cast<float>(random.normal());
    const auto model = random_model(descriptors, 11);
    const RowMatrixf ours = device.surface.votes(*model, samples, descriptors);
    const RowMatrixf theirs = votes_of_cpu(*model, cpu, samples, descriptors);
    REQUIRE(ours.cols() == theirs.cols());
    tell("votes", of, (ours - theirs).cwiseAbs().maxCoeff() / theirs.maxCoeff(), 1e-3);
    CHECK(ours.rightCols(ours.cols() - 11).isZero());
  }
}

TEST_CASE("functional maps") {
  const Subject& source = subjects()[1];  // onto itself among others
  const Eigenbasis there = eigenbasis(source.operators.L, source.operators.mass, eigen_params(), {});
  const std::vector<int32_t> at = farthest_points(source.mesh->surface.positions, 150);
  SpectralSamples from{RowMatrixf(at.size(), eigenpairs), Eigen::VectorXf::Constant(150, 1 / 150.0F)};
  from.weight.tail(10).setZero();
  for (size_t p = 0; p < at.size(); ++p)
    from.Phi.row(static_cast<Eigen::Index>(p)) = there.Phi.row(at[p]).cast<float>();
  for (const Subject& of : subjects()) {
    const OnDevice device(of);
    const SpectralTargets to{device.surface.spectrum(eigen_params()).Phi.cast<float>(),
                             some_vertices(of, 250)};
    std::vector<int32_t> initial;
    for (const int32_t v : at) initial.push_back(v % of.mesh->surface.vertex_count());
    for (const MapParams& params : {MapParams{.first = 12, .last = 60, .step = 12, .exact_from = 140},
                                    MapParams{.first = 20, .last = 20, .step = 4, .exact_from = 1000},
                                    MapParams{.first = 16, .last = 58, .step = 20, .exact_from = 0}}) {
      const FunctionalMap ours = device.surface.zoom_out(from, to, initial, params);
      const FunctionalMap theirs = zoom_out(from, to, initial, params);
      REQUIRE(ours.C.rows() == theirs.C.rows());
      int different = 0;
      for (size_t p = 0; p < at.size(); ++p) different += ours.image[p] != theirs.image[p];
      tell("images", of, different / 150.0, 0.02);  // where two are as near, a rounding decides
      tell("maps", of, (ours.C - theirs.C).norm() / theirs.C.norm(), 1e-2);
      tell("residual", of, std::abs(ours.residual - theirs.residual) / theirs.residual, 1e-3);
    }
  }
}

// ---- Whole detections

namespace {

TriangleMesh posed_mesh(const creatures::Character& character) {
  TriangleMesh mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(character.posed.size()), 3);
  for (size_t v = 0; v < character.posed.size(); ++v)
    mesh.positions.row(static_cast<Eigen::Index>(v)) = character.posed[v];
  mesh.triangles.resize(static_cast<Eigen::Index>(character.rest.triangles.size()), 3);
  for (size_t t = 0; t < character.rest.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      mesh.triangles(static_cast<Eigen::Index>(t), i) = character.rest.triangles[t][i];
  return mesh;
}

creatures::Character humanoid(uint64_t seed) {
  return creatures::make_character(creatures::families()[0], "humanoid", seed);
}

// Preset paper analyses a surface as it is, so it is given small ones.
std::shared_ptr<const PreparedMesh> coarse(const std::shared_ptr<const PreparedMesh>& mesh) {
  return make_proxy(mesh, 1000).coarse;
}
MarkedShape coarse(const MarkedShape& shape) {
  const Proxy proxy = make_proxy(shape.mesh, 1000);
  MarkedShape result{proxy.coarse, {}};
  for (const auto& mark : shape.marks) result.marks.push_back(to_coarse(proxy, std::span(&*mark, 1))[0]);
  return result;
}

std::shared_ptr<const LandmarkModel> trained(Preset preset) {
  TrainingSet set;
  for (const auto& mark : humanoid(100).landmarks) set.landmark_names.push_back(mark.name);
  for (uint64_t seed = 100; seed < (sanitized ? 104 : 112); ++seed) {
    const auto character = humanoid(seed);
    MarkedShape shape{std::make_shared<PreparedMesh>(prepare(posed_mesh(character))), {}};
    for (const auto& mark : character.landmarks)
      shape.marks.push_back(to_surface(*shape.mesh, {mark.triangle, mark.barycentric}));
    if (preset == Preset::paper) shape = coarse(shape);
    set.shapes.push_back(std::move(shape));
  }
  TrainParams params = TrainParams::from_preset(preset);
  params.eigenpair_count = 100, params.sampling_rate = 0.3, params.tree_count = 10, params.spoiled_copies = 0;
  params.learns_confidence = false;
  if (preset == Preset::default_preset) params.proxy_vertices = sanitized ? 600 : 900;
  return std::make_shared<LandmarkModel>(train(set, params, {}));
}

const std::shared_ptr<const LandmarkModel>& model() {
  static const auto made = trained(Preset::default_preset);
  return made;
}

std::shared_ptr<const PreparedMesh> unseen(uint64_t seed) {
  return std::make_shared<PreparedMesh>(prepare(posed_mesh(humanoid(seed))));
}

Execution on(const Backend* where) {
  Execution execution;
  execution.thread_count = 2, execution.backend = where;
  return execution;
}

void check_same_bits(const Detection& a, const Detection& b) {
  REQUIRE(a.landmarks.size() == b.landmarks.size());
  for (size_t l = 0; l < a.landmarks.size(); ++l) {
    CHECK(a.landmarks[l].position == b.landmarks[l].position);
    CHECK(a.landmarks[l].confidence == b.landmarks[l].confidence);
  }
  CHECK(a.votes == b.votes);
}

// The maps of the training shapes end in whole vertices: where a rounding decides, one of a dozen opinions moves by an edge.
void check_agrees(const std::shared_ptr<const LandmarkModel>& model_of) {
  double worst = 0;
  const bool paper = model_of->params.preset == Preset::paper;
  for (uint64_t seed = 200; seed < 203; ++seed) {
    const auto mesh = paper ? coarse(unseen(seed)) : unseen(seed);
    const Detection ours = detect(model_of, mesh, {}, on(backend.get())),
                    theirs = detect(model_of, mesh, {}, on(nullptr));
    CHECK(ours.by_backend);
    CHECK_FALSE(theirs.by_backend);
    const double edge = make_operators(theirs.proxy.coarse->surface).mean_edge * theirs.proxy.scale();
    for (size_t l = 0; l < ours.landmarks.size(); ++l) {
      CHECK(ours.landmarks[l].status == theirs.landmarks[l].status);
      worst = std::max(worst, (ours.landmarks[l].position - theirs.landmarks[l].position).norm() / edge);
    }
  }
  std::printf("landmarks at most %.4f edges apart, 0.1 allowed\n", worst);
  CHECK(worst <= 0.1);
}

}  // namespace

TEST_CASE("landmarks are the same within a tenth of an edge, preset default" * doctest::skip(sanitized)) {
  check_agrees(model());
}

TEST_CASE("landmarks are the same within a tenth of an edge, preset paper" * doctest::skip(sanitized)) {
  check_agrees(trained(Preset::paper));
}

TEST_CASE("the device gives the same bits each time, and by any number of threads") {
  const auto mesh = unseen(200);
  Execution one = on(backend.get());
  one.thread_count = 1;
  check_same_bits(detect(model(), mesh, {}, one), detect(model(), mesh, {}, on(backend.get())));
}

TEST_CASE("an analysis that is kept needs no device any more" * doctest::skip(sanitized)) {
  std::string note;
  const auto mesh = unseen(201);
  detect(model(), mesh, {}, on(backend.get()));
  const int64_t live = faults() ? faults()->live.load() : 0;  // the model's forest stays
  const SurfaceAnalysis kept = analyse_to_keep(model()->params, mesh, {}, on(backend.get()), note);
  CHECK(note.empty());
  CHECK_FALSE(kept.on_backend);
  CHECK_FALSE(kept.distances.steps.empty());
  const Detection detection = detect(model(), kept, {}, on(backend.get()));
  CHECK_FALSE(detection.by_backend);
  const Detection theirs = detect(model(), mesh, {}, on(nullptr));
  const double edge = kept.operators.mean_edge * kept.proxy.scale();
  for (size_t l = 0; l < theirs.landmarks.size(); ++l)
    CHECK((detection.landmarks[l].position - theirs.landmarks[l].position).norm() <= 0.1 * edge);
  if (faults()) CHECK(faults()->live == live);
}

TEST_CASE("wherever a device fails, the CPU does the whole mesh") {
  if (!faults()) return;
  const auto mesh = unseen(202);
  const Detection theirs = detect(model(), mesh, {}, on(nullptr));
  faults()->allocations = 0, faults()->launches = 0, faults()->downloads = 0;
  CHECK(detect(model(), mesh, {}, on(backend.get())).by_backend);
  const int64_t allocations = faults()->allocations, launches = faults()->launches,
                downloads = faults()->downloads;
  REQUIRE(allocations > 40);
  REQUIRE(launches > 20);
  const auto check_fails = [&](std::atomic<int64_t>& counter, int64_t at, const char* why) {
    counter = at;
    const Detection ours = detect(model(), mesh, {}, on(backend.get()));
    counter = -1;
    CHECK_FALSE(ours.by_backend);
    REQUIRE(!ours.warnings.empty());
    CHECK(ours.warnings.back() == std::string("the GPU failed (") + why + "), so the CPU did this mesh");
    check_same_bits(ours, theirs);
    CHECK(backend->works());
  };
  for (int i = 0; i < (sanitized ? 2 : 3); ++i) {
    check_fails(faults()->allocation, i * (allocations - 1) / 2, "out of device memory");
    check_fails(faults()->download, i * (downloads - 1) / 2,
                i == 0 ? "the eigenvalues of the surface did not converge on the GPU"
                       : "the device's results make no sense");
    check_fails(faults()->launch, i * (launches - 1) / 2, "a launch failed");
  }
  std::string note;
  faults()->launch = 9;  // of the many in the spectrum
  analyse_to_keep(model()->params, mesh, {}, on(backend.get()), note);
  CHECK(note.find("a launch failed") != std::string::npos);
  faults()->launch = -1;
}

TEST_CASE("after a lasting failure the device is asked no more") {
  if (!faults()) return;
  const auto mesh = unseen(202);
  const auto other = load_backend(files, 0).backend;
  REQUIRE(other);
  faults()->lasting = true, faults()->launch = 7;
  CHECK_FALSE(detect(model(), mesh, {}, on(other.get())).by_backend);
  faults()->launch = -1, faults()->lasting = false;
  CHECK_FALSE(other->works());
  CHECK(std::string(other->reason()).find("a launch failed") != std::string::npos);
  faults()->allocations = 0;
  const Detection next = detect(model(), mesh, {}, on(other.get()));
  CHECK(next.warnings.empty());
  CHECK(faults()->allocations == 0);
}

TEST_CASE("many meshes at once, one queue each") {
  std::vector<std::shared_ptr<const PreparedMesh>> meshes;
  for (uint64_t seed = 200; seed < 203; ++seed) meshes.push_back(unseen(seed));
  std::vector<Detection> together(meshes.size());
  Execution four;
  four.thread_count = 4;
  parallel_for(four, static_cast<int64_t>(meshes.size()), [&](int64_t i) {
    Execution inner = four.inner();
    inner.backend = backend.get();
    together[static_cast<size_t>(i)] = detect(model(), meshes[static_cast<size_t>(i)], {}, inner);
  });
  for (size_t i = 0; i < meshes.size(); ++i) {
    CHECK(together[i].by_backend);
    check_same_bits(together[i], detect(model(), meshes[i], {}, on(backend.get())));
  }
}

TEST_CASE("nothing is left on the device") {
  if (faults()) {
    backend.reset();
    CHECK(faults()->live == 0);
  }
}

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  files = {argv[1], argv[2]};
  LoadedBackend loaded = load_backend(files, 0);
  if (!loaded.backend) {
    std::printf("skipped: no device (%s)\n", loaded.reason.c_str());
    return 77;
  }
  backend = std::move(loaded.backend);
  std::printf("%s\n", backend->reason());
  doctest::Context context(argc - 2, argv + 2);
  const int result = context.run();
  backend.reset();
  return result;
}
