#include "stages.h"

#include <algorithm>

#include "analysis/leaf_votes.h"
#include "descriptors/si_hks.h"
#include "landmarks/train.h"

namespace focal_bench {
namespace {

using namespace focal;

constexpr int lanes = HeatMethod::lanes;

SparseMatrix shifted_laplacian(const Operators& operators) {
  SparseMatrix A = operators.L;
  for (int32_t i = 0; i < A.rows(); ++i) A.coeffRef(i, i) += operators.mass[i];
  return A;
}

template <class T>
void solve_one_block(const SparseCholesky& factor) {
  const AlignedArray<T> sides(static_cast<size_t>(factor.size()) * lanes);
  std::fill_n(sides.data(), sides.size(), T(1));
  factor.solve_block(sides.data());
}

double step_of(const HeatMethod& heat) { return heat.distance_bound() / 65535; }

std::vector<uint16_t> distance_blocks(const HeatMethod& heat, const std::vector<int32_t>& samples) {
  const size_t block = static_cast<size_t>(heat.vertex_count()) * lanes;
  std::vector<uint16_t> blocks((samples.size() + lanes - 1) / lanes * block);
  heat.for_each_block(std::span(samples), {}, [&](int64_t first, int32_t, const float* distances) {
    for (size_t i = 0; i < block; ++i)
      blocks[first / lanes * block + i] = static_cast<uint16_t>(distances[i] / step_of(heat) + 0.5);
  });
  return blocks;
}

RowMatrixf cast_votes(const Values& values, const Execution& execution) {
  RowMatrixf votes = RowMatrixf::Zero(values.heat.vertex_count(), values.tables.stride());
  add_distribution_votes(values.tables, static_cast<int32_t>(values.samples.size()),
                         {values.blocks.data(), step_of(values.heat), values.heat.vertex_count()}, 0, votes,
                         execution);
  return votes;
}

VoteTables leaf_tables(const Values& values, const Execution& execution) {
  return LeafVotes(*values.model, values.descriptors, execution)
      .tables(0, static_cast<int32_t>(values.descriptors.rows()), execution);
}

DistanceFields fields_of(const Values& values, const Execution& execution) {
  return [&](std::span<const int32_t> vertices) { return values.heat.distances(vertices, execution); };
}

Peaks find(const Values& values, const Execution& execution) {
  return peaks_of(values.votes, values.tables.landmarks, values.mesh->surface, values.operators, execution);
}

TrainParams full_resolution() {
  TrainParams params = TrainParams::from_preset(Preset::default_preset);
  params.eigenpair_count = 200, params.proxy_vertices = 0, params.sampling_rate = 0.5;
  params.bulge = false;  // signatures alone, as the stock pipeline has
  return params;
}

}  // namespace

Values::Values(Subject of, std::shared_ptr<const LandmarkModel> known)
    : subject(std::move(of)),
      model(known ? known : trained(subject, full_resolution(), 0)),
      quick_model(known ? known : trained(subject, TrainParams::from_preset(Preset::default_preset), 0)) {
  mesh = std::make_shared<PreparedMesh>(prepare(subject.test));
  operators = make_operators(mesh->surface, bridges_of(*mesh));
  heat = HeatMethod(mesh->surface, operators);
  factor = SparseCholesky(shifted_laplacian(operators));
  basis = focal_eigenpairs(operators, model->params.eigenpair_count, {});
  samples = drawn_samples(mesh->surface.vertex_count());
  descriptors = si_hks(basis, operators.area, samples).cast<float>();
  tables = leaf_tables(*this, {});
  blocks = distance_blocks(heat, samples);
  votes = cast_votes(*this, {});
  peaks = find(*this, {});
}

std::vector<Stage> focal_stages() {
  using V = const Values&;
  using E = const Execution&;
  return {
      {"prepare", [](V v, E) { prepare(v.subject.test); }, false},
      {"operators", [](V v, E) { make_operators(v.mesh->surface, bridges_of(*v.mesh)); }, false},
      {"factor", [](V v, E) { SparseCholesky(shifted_laplacian(v.operators)); }, false},
      {"solve_32_double", [](V v, E) { solve_one_block<double>(v.factor); }, false},
      {"solve_32_float", [](V v, E) { solve_one_block<float>(v.factor); }, false},
      {"eigenpairs", [](V v, E e) { focal_eigenpairs(v.operators, v.model->params.eigenpair_count, e); }},
      {"si_hks", [](V v, E e) { si_hks(v.basis, v.operators.area, v.samples, e); }},
      {"heat_factors", [](V v, E) { HeatMethod(v.mesh->surface, v.operators); }, false},
      {"heat_distances", [](V v, E e) { focal_distances(v.heat, v.samples, e); }},
      {"leaf_tables", [](V v, E e) { leaf_tables(v, e); }},
      {"votes", [](V v, E e) { cast_votes(v, e); }},
      {"peaks", [](V v, E e) { find(v, e); }},
      {"constellation",
       [](V v, E e) { choose_among(v.peaks, v.votes, *v.model, *v.mesh, fields_of(v, e), e); }},
      {"detect",
       [](V v, E e) {
         whole_detect(v.quick_model, v.subject.test, detect_variants()[0].params, e.threads());
       }},
      {"train", [](V v, E e) { train(v.subject.training, v.quick_model->params, e); }},
  };
}

std::vector<Variant> detect_variants() {
  DetectParams interactive, best;
  interactive.quality = Quality::interactive;
  best.quality = Quality::best;
  return {{"interactive", interactive}, {"best", best}, {"full resolution", interactive, true}};
}

Detection whole_detect(const std::shared_ptr<const LandmarkModel>& model, const TriangleMesh& mesh,
                       const DetectParams& params, int threads) {
  return detect(model, std::make_shared<PreparedMesh>(prepare(mesh)), params, threads_of(threads));
}

SurfaceAnalysis analysed(const Values& values, const DetectParams& params, int threads) {
  SurfaceAnalysis analysis =
      analyse_for(values.quick_model->params, values.mesh, params, threads_of(threads));
  keep_distances(analysis, threads_of(threads));
  return analysis;
}

Detection second_detect(const Values& values, const SurfaceAnalysis& analysis, const DetectParams& params,
                        int threads) {
  return detect(values.quick_model, analysis, params, threads_of(threads));
}

Eigenbasis focal_eigenpairs(const Operators& operators, int32_t count, const Execution& execution) {
  EigenParams params;
  params.count = count;
  params.tolerance = 1e-6;
  return eigenbasis(operators.L, operators.mass, params, execution);
}

void focal_distances(const HeatMethod& heat, const std::vector<int32_t>& sources,
                     const Execution& execution) {
  heat.for_each_block(std::span(sources), execution, [](int64_t, int32_t, const float*) {});
}

}  // namespace focal_bench
