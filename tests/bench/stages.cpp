#include "stages.h"

#include <algorithm>
#include <cstring>

#include "descriptors/descriptor.h"
#include "landmarks/leaf_votes.h"
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

std::vector<float> distance_blocks(const HeatMethod& heat, const std::vector<int32_t>& samples) {
  const size_t block = static_cast<size_t>(heat.vertex_count()) * lanes;
  std::vector<float> blocks((samples.size() + lanes - 1) / lanes * block);
  heat.for_each_block(std::span(samples), {}, [&](int64_t first, int32_t, const float* distances) {
    std::memcpy(&blocks[first / lanes * block], distances, block * sizeof(float));
  });
  return blocks;
}

// Tables block by block, as in detection: they are small enough to stay in the cache.
void make_tables(const Values& values, const Execution& execution) {
  const auto count = static_cast<Eigen::Index>(values.samples.size());
  for (Eigen::Index first = 0; first < count; first += lanes)
    leaf_vote_tables(*values.model,
                     values.descriptors.middleRows(first, std::min<Eigen::Index>(lanes, count - first)),
                     execution);
}

RowMatrixf cast_votes(const Values& values, const Execution& execution) {
  RowMatrixf votes = RowMatrixf::Zero(values.heat.vertex_count(), values.tables.landmarks);
  const auto count = static_cast<int32_t>(values.samples.size());
  VoteTables part = values.tables;
  const size_t table = static_cast<size_t>(part.bins) * part.landmarks;
  for (int32_t first = 0; first < count; first += lanes) {
    const int32_t used = std::min(lanes, count - first);
    part.weight.assign(values.tables.of(first), values.tables.of(first) + used * table);
    add_distribution_votes(part, &values.blocks[static_cast<size_t>(first) * values.heat.vertex_count()],
                           used, votes, execution);
  }
  return votes;
}

DistanceFields fields_of(const Values& values, const Execution& execution) {
  return [&](std::span<const int32_t> vertices) { return values.heat.distances(vertices, execution); };
}

}  // namespace

Values::Values(Subject of, std::shared_ptr<const LandmarkModel> known)
    : subject(std::move(of)), model(known ? std::move(known) : trained(subject, 0)) {
  mesh = std::make_shared<PreparedMesh>(prepare(subject.test));
  operators = make_operators(mesh->surface, mesh->bridges);
  heat = HeatMethod(mesh->surface, operators);
  factor = SparseCholesky(shifted_laplacian(operators));
  basis = focal_eigenpairs(operators, model->params.eigenpair_count, {});
  samples = drawn_samples(mesh->surface.vertex_count());
  descriptors = si_hks(basis, operators.area, samples).cast<float>();
  tables = leaf_vote_tables(*model, descriptors, {});
  blocks = distance_blocks(heat, samples);
  votes = cast_votes(*this, {});
  peaks = peaks_of(votes, fields_of(*this, {}));
}

std::vector<Stage> focal_stages() {
  using V = const Values&;
  using E = const Execution&;
  return {
      {"prepare", [](V v, E) { prepare(v.subject.test); }, false},
      {"operators", [](V v, E) { make_operators(v.mesh->surface, v.mesh->bridges); }, false},
      {"factor", [](V v, E) { SparseCholesky(shifted_laplacian(v.operators)); }, false},
      {"solve_32_double", [](V v, E) { solve_one_block<double>(v.factor); }, false},
      {"solve_32_float", [](V v, E) { solve_one_block<float>(v.factor); }, false},
      {"eigenpairs", [](V v, E e) { focal_eigenpairs(v.operators, v.model->params.eigenpair_count, e); }},
      {"si_hks", [](V v, E) { si_hks(v.basis, v.operators.area, v.samples); }, false},
      {"heat_factors", [](V v, E) { HeatMethod(v.mesh->surface, v.operators); }, false},
      {"heat_distances", [](V v, E e) { focal_distances(v.heat, v.samples, e); }},
      {"leaf_tables", make_tables},
      {"votes", [](V v, E e) { cast_votes(v, e); }},
      {"peaks", [](V v, E e) { peaks_of(v.votes, fields_of(v, e)); }},
      {"constellation",
       [](V v, E e) { choose_among(v.peaks, v.votes, *v.model, *v.mesh, fields_of(v, e), e); }},
      {"detect",
       [](V v, E e) { whole_detect(v.model, v.subject.test, detect_variants()[0].params, e.threads()); }},
      {"train", [](V v, E e) { train(v.subject.training, v.model->params, e); }},
  };
}

std::vector<Variant> detect_variants() {
  DetectParams interactive, best;
  interactive.quality = Quality::interactive;
  best.quality = Quality::best;
  return {{"interactive", interactive}, {"best", best}};
}

Detection whole_detect(const std::shared_ptr<const LandmarkModel>& model, const TriangleMesh& mesh,
                       const DetectParams& params, int threads) {
  return detect(model, std::make_shared<PreparedMesh>(prepare(mesh)), params, threads_of(threads));
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
