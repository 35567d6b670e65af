// All backends, stage by stage, against the CPU, on surfaces that are easy and surfaces that are not; whole detections are in
// backend_detections.cpp.
// usage: focal_backend_test DRIVER MODULE [doctest options]. Exit code 77: there is no such device.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "analysis/device_surface.h"
#include "analysis/leaf_votes.h"
#include "analysis/surface_analysis.h"
#include "base/random.h"
#include "base/shared_library.h"
#include "compute/backend_under_test.h"
#include "descriptors/descriptor.h"
#include "descriptors/si_hks.h"
#include "geodesics/heat_method.h"
#include "surfaces.h"
#include "vote/peaks.h"

using namespace focal;
using namespace focal_test;

HostFaults* focal_test::faults() {
  std::string why;
  void* module = open_library(files.module, why);
  void* found = module ? find_symbol(module, "focal_host_faults") : nullptr;
  return found ? reinterpret_cast<HostFaults* (*)()>(found)() : nullptr;
}

namespace {

struct Subject {
  const char* name;
  std::shared_ptr<const PreparedMesh> mesh;
  Operators operators;
};

Subject subject(const char* name, TriangleMesh mesh) {
  auto prepared = std::make_shared<const PreparedMesh>(prepare(std::move(mesh)));
  Operators operators = make_operators(prepared->surface, bridges_of(*prepared), true);
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
      : distance(std::make_shared<DeviceDistance>(of.mesh, of.operators, false, *backend)),
        surface(*distance->surface()) {}
  std::shared_ptr<DeviceDistance> distance;
  const DeviceSurface& surface;
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

TEST_CASE("separate parts lie a gap apart with a device too") {
  for (const Subject& of : subjects()) {
    if (of.mesh->components == 1) continue;
    const AnalysisParams params{.eigenpair_count = eigenpairs};
    Execution execution;
    execution.backend = backend.get();
    const auto sources = points_at(of.mesh->surface, some_vertices(of, 40));
    const RowMatrixf ours = analyse_surface(of.mesh, params, execution).metric->distances(sources, {}),
                     theirs = analyse_surface(of.mesh, params, {}).metric->distances(sources, {});
    tell("gaps", of, (ours - theirs).cwiseAbs().maxCoeff() / theirs.maxCoeff(), 1e-5);
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

TEST_CASE("signatures that are weights of squared eigenfunctions") {
  for (const Subject& of : subjects()) {
    const OnDevice device(of);
    const Eigenbasis basis = device.surface.spectrum(eigen_params());
    const auto vertices = some_vertices(of, 100);
    for (const DescriptorKind& kind : descriptor_kinds()) {
      if (!kind.spectral_weights) continue;
      const double area = of.operators.area;
      const RowMatrixf ours =
          device.surface.spectral_signatures(kind.spectral_weights(basis.lambda, area), area, vertices);
      const RowMatrix theirs = kind.describe({of.mesh->surface, of.operators, basis}, vertices, {});
      tell(kind.name.data(), of, (ours.cast<double>() - theirs).cwiseAbs().maxCoeff() / theirs.maxCoeff(),
           1e-6);
    }
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
    const auto& positions = of.mesh->surface.positions;
    const double radius = 0.1 * std::sqrt(of.operators.area);
    const auto peaks = find_peaks(
        ours, 11, 6, 0, [&](int32_t v) { return connected_ball(of.operators.L, positions, v, radius); }, {});
    CHECK(device.surface.peaks(11, 6, radius) == peaks);
    CHECK_THROWS_AS(device.surface.peaks(11, 6, radius), const BackendFailure&);  // they are used up
  }
}

namespace {

// As the paper has it, edge by edge and vertex by vertex. distances: sources x vertices.
RowMatrixf isoline_votes(const RowMatrixf& samples, const RowMatrixf& all, const RowMatrixf& radii, double mu,
                         const Edges& edges, float neighbourhood) {
  RowMatrixf votes = RowMatrixf::Zero(all.cols(), radii.cols()), mean = votes;
  for (Eigen::Index j = 0; j < samples.rows(); ++j) {
    const Eigen::RowVectorXf share = samples.row(j) / samples.row(j).maxCoeff();
    for (Eigen::Index e = 0; e < edges.rows(); ++e)
      for (Eigen::Index k = 0; k < radii.cols(); ++k) {
        const float low = std::min(share[edges(e, 0)], share[edges(e, 1)]),
                    high = std::max(share[edges(e, 0)], share[edges(e, 1)]), r = radii(j, k);
        if (low > r || r > high) continue;
        for (int side = 0; side < 2; ++side)
          votes(edges(e, side), k) += std::exp(-static_cast<float>(mu) * r * r);
      }
  }
  for (Eigen::Index v = 0; v < all.rows(); ++v) {
    int neighbours = 0;
    for (Eigen::Index w = 0; w < all.cols(); ++w)
      if (all(v, w) < neighbourhood * all.row(v).maxCoeff()) mean.row(v) += votes.row(w), ++neighbours;
    mean.row(v) /= static_cast<float>(std::max(neighbours, 1));
  }
  return mean;
}

}  // namespace

TEST_CASE("votes along isolines, averaged") {
  for (const Subject& of : subjects()) {
    const OnDevice device(of);
    const int32_t n = of.mesh->surface.vertex_count();
    const auto samples = some_vertices(of, 280);  // more than the device takes at once
    std::vector<int32_t> all(static_cast<size_t>(n));
    for (int32_t v = 0; v < n; ++v) all[static_cast<size_t>(v)] = v;
    Random random(6);
    RowMatrixf radii(samples.size(), 5);
    for (Eigen::Index i = 0; i < radii.size(); ++i)
      radii.data()[i] = static_cast<float>(1.2 * random.uniform() - 0.1);  // some beyond everything
    const Edges edges = edges_of(of.mesh->surface);
    const RowMatrixf ours = device.surface.isoline_votes(samples, radii, 5, edges, 0.06F);
    const RowMatrixf theirs = isoline_votes(device.distance->distances(samples, {}),
                                            device.distance->distances(all, {}), radii, 5, edges, 0.06F);
    // Where an isoline passes through a vertex, a rounding decides on which side of it.
    tell("isolines", of, (ours - theirs).cwiseAbs().sum() / theirs.sum(), 1e-3);
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
                             some_vertices(of, 250), of.mesh->surface.positions};
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
  const int64_t left = faults() ? faults()->live.load() : 0;
  if (left != 0) std::printf("%lld bytes are left on the device\n", static_cast<long long>(left));
  return left == 0 ? result : 1;
}
